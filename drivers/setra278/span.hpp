// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar::setra278 {

/// The straight line of a Setra 278, as its order code and its converter's wiring say: 0 … 2.5 V or 0 … 5 V
/// for 600 … 1100, 500 … 1100 or 800 … 1100 hPa. With a divider in front of the converter: the volts behind
/// it.
struct Span {
  double low_v = 0.0;
  double high_v = 2.5;
  double low_pa = 60'000.0;
  double high_pa = 110'000.0;
};

/// Share of the span at each end that is no measurement. A wire that is off, a supply that is missing or a
/// converter at its limit read an end of the span or a little beyond; air pressure is not there.
inline constexpr double kEndShare = 0.005;

/// Which rule the span breaks, as a text that never dies; nullptr when none.
[[nodiscard]] const char* broken_rule(const Span& span) noexcept;

/// A pressure, or why there is none.
struct Reading {
  const char* fault = nullptr;  ///< a text that never dies; nullptr: pressure_pa is valid
  double pressure_pa = 0.0;
};

[[nodiscard]] Reading pressure_of(const Span& span, double volts) noexcept;

}  // namespace isobar::setra278
