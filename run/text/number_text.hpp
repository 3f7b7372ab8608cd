// SPDX-License-Identifier: BSD-3-Clause
// Conversion between numbers and text: independent of the locale, lossless.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace isobar::text {

/// Longest text of a double or an int64, sign and exponent included.
inline constexpr std::size_t kNumberTextBytes = 32;

/// The shortest text that reads back as the same bits.
template <typename Number>
std::string number_text(Number value) {
  std::array<char, kNumberTextBytes> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// `text` without the blanks and quotation marks around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Parses a text that is one number and nothing else; "nan" and "inf" count. False for anything else.
[[nodiscard]] bool parse_number(std::string_view text, double& value);

/// Parses a whole number of 64 bits, also in decimal or exponent notation ("2e9"). False for anything else.
[[nodiscard]] bool parse_number(std::string_view text, std::int64_t& value);

/// Parses seconds as nanoseconds digit by digit: exact to 1 ns, where a double of 1.7e9 s holds 240 ns. False
/// for exponent notation and for numbers that do not fit 64 bits.
[[nodiscard]] bool parse_seconds(std::string_view text, std::int64_t& value_ns);

}  // namespace isobar::text
