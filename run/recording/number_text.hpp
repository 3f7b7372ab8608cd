// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text, without locale and without loss.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace isobar::recording {

/// Longest text of a double or an int64, sign and exponent included.
inline constexpr std::size_t kNumberTextBytes = 32;

/// The shortest text that reads back as the same bits.
template <typename Number>
std::string number_text(Number value) {
  std::array<char, kNumberTextBytes> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// Without blanks and quotation marks around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Reads a number that fills the whole text. NaN and infinities are numbers here. False for anything else.
[[nodiscard]] bool parse_number(std::string_view text, double& value);

/// Reads a count of nanoseconds: an integer, or a number in decimal or exponent notation that is whole.
[[nodiscard]] bool parse_number(std::string_view text, std::int64_t& value);

/// Reads seconds with any number of decimals as nanoseconds, without the rounding of a double. False when it
/// is no plain decimal number or does not fit.
[[nodiscard]] bool parse_seconds(std::string_view text, std::int64_t& value_ns);

}  // namespace isobar::recording
