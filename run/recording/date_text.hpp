// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace isobar::recording {

/// Parses a date and time in ISO 8601 or in the form of loggers: 2020-04-03 18:05; optional are 'T' instead
/// of the blank, seconds with decimals, and Z or an offset such as +02:00 (default UTC).
/// @param stamp_ns nanoseconds since 1970
/// @return false for any other text and for days that do not exist
[[nodiscard]] bool parse_date(std::string_view text, std::int64_t& stamp_ns);

}  // namespace isobar::recording
