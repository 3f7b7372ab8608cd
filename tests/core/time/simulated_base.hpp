// SPDX-License-Identifier: BSD-3-Clause
// Simulated base stations and a receiver, for the tests of BaseStationStream.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/time/base_station_stream.hpp"

namespace isobar::test::base_stations {

inline constexpr std::int64_t kMs = 1'000'000;
inline constexpr std::int64_t kSecond = 1'000'000'000;
inline constexpr std::int64_t kRobot = 1'700'000'000 * kSecond;  // robot clock at time 0
inline constexpr std::int64_t kBase = 1'000'000 * kSecond;       // a base station whose clock started in 1970
inline constexpr std::uint64_t kFirst = 11;
inline constexpr std::uint64_t kSecondSender = 22;

/// A base station; sample i is measured at true time i * period_ns.
struct Base {
  std::int64_t period_ns = kSecond / 32;
  std::int64_t clock_ns = kBase;  ///< its clock at time 0
  double pressure_pa = 98'000.0;  ///< distinguishes one station's samples from another's

  [[nodiscard]] std::int64_t samples_in(std::int64_t time_ns) const { return time_ns / period_ns; }
  [[nodiscard]] PressureSample sample(std::int64_t i) const {
    return {clock_ns + i * period_ns, pressure_pa + 0.001 * static_cast<double>(i), 20.0};
  }
};

/// A stream and the true time.
struct Listener {
  BaseStationStream stream;
  std::int64_t newest_ns = 0;
  double worst_error_ms = 0.0;

  /// Delivers sample `i` with a transport delay and checks the invariants of an accepted sample.
  BaseVerdict give(const Base& base, std::int64_t i, std::int64_t delay_ns = 2 * kMs,
                   std::uint64_t sender = kFirst) {
    const std::int64_t true_ns = kRobot + i * base.period_ns;
    PressureSample sample = base.sample(i);
    const BaseVerdict verdict = stream.check(sender, sample, true_ns + delay_ns);
    if (verdict == BaseVerdict::kAccepted) {
      CHECK(sample.stamp_ns > newest_ns);
      newest_ns = sample.stamp_ns;
      worst_error_ms =
          std::max(worst_error_ms, std::abs(static_cast<double>(sample.stamp_ns - true_ns)) * 1e-6);
    }
    return verdict;
  }
  [[nodiscard]] std::uint64_t count(BaseVerdict verdict) const { return stream.status().count(verdict); }
};

inline Base base_at(double rate_hz) {
  Base base;
  base.period_ns = static_cast<std::int64_t>(1e9 / rate_hz);
  return base;
}

}  // namespace isobar::test::base_stations
