// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace isobar::recording {

/// Parses a date and time in ISO 8601 or in the form of loggers: 2020-04-03 18:05, 2020/04/03 18:05, 03.04.2020 18:05;
/// optional are 'T' instead of the blank, seconds with decimals after a point or a comma, and Z or an offset such as
/// +02:00 (default UTC). Not 03/04/2020: its day and its month cannot be told apart.
/// @param stamp_ns nanoseconds since 1970
/// @return false for any other text and for days that do not exist
[[nodiscard]] bool parse_date(std::string_view text, std::int64_t& stamp_ns);

/// Parses a time of day: 9:05, 18:05:31.25.
/// @param of_day_ns nanoseconds since midnight
[[nodiscard]] bool parse_time_of_day(std::string_view text, std::int64_t& of_day_ns);

}  // namespace isobar::recording
