// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar::setra278 {

/// Linear characteristic of a Setra 278, by its order code: 0 … 2.5 V or 0 … 5 V for 600 … 1100, 500 … 1100
/// or 800 … 1100 hPa. Volts are those at the converter, after a voltage divider if there is one.
struct Span {
  double low_v = 0.0;
  double high_v = 2.5;
  double low_pa = 60'000.0;
  double high_pa = 110'000.0;
};

/// Share of the span at each end that is refused. An open wire, a missing supply or a saturated converter
/// read an end of the span or slightly beyond; real air pressure does not.
inline constexpr double kEndShare = 0.005;

/// The rule that the span breaks, a static text; nullptr when none.
[[nodiscard]] const char* broken_rule(const Span& span) noexcept;

/// Pressure or fault.
struct Reading {
  const char* fault = nullptr;  ///< a static text; nullptr: pressure_pa is valid
  double pressure_pa = 0.0;
};

[[nodiscard]] Reading pressure_of(const Span& span, double volts) noexcept;

}  // namespace isobar::setra278
