// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// Date and time of day of a sensor's packet, UTC.
struct CivilTime {
  int year = 1970;
  unsigned month = 1;
  unsigned day = 1;
  unsigned hour = 0;
  unsigned minute = 0;
  unsigned second = 0;
  std::int64_t ns = 0;

  [[nodiscard]] constexpr bool is_valid() const {
    return year >= 1970 && year < 2200 && month >= 1 && month <= 12 && day >= 1 && day <= 31 && hour < 24 &&
           minute < 60 && second <= 60 && ns >= 0 && ns < 1'000'000'000;
  }
  /// Nanoseconds since 1970-01-01, proleptic Gregorian calendar without leap seconds: days from the era of 400
  /// years, whose years begin in March so that leap days are last.
  [[nodiscard]] constexpr std::int64_t since_epoch_ns() const {
    const std::int64_t y = year - (month <= 2 ? 1 : 0);
    const std::int64_t era = y / 400;
    const std::int64_t year_of_era = y - era * 400;
    const std::int64_t day_of_year =
        (153 * (static_cast<std::int64_t>(month) + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
    const std::int64_t day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
    const std::int64_t days = era * 146'097 + day_of_era - 719'468;
    return ((days * 24 + hour) * 60 + minute) * 60'000'000'000 + second * std::int64_t{1'000'000'000} + ns;
  }
};

}  // namespace isobar
