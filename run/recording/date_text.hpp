// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace isobar::recording {

/// Reads a date and time as ISO 8601 and loggers write it: 2020-04-03 18:05, with 'T' instead of the blank,
/// seconds and their decimals, Z or an offset such as +02:00. Without one it is taken as UTC. Gives
/// nanoseconds since 1970; false for anything else, also for days that do not exist.
[[nodiscard]] bool parse_date(std::string_view text, std::int64_t& stamp_ns);

}  // namespace isobar::recording
