// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/number_text.hpp"

#include <cmath>

namespace isobar::text {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
/// Whole seconds beyond this would overflow nanoseconds.
constexpr std::int64_t kMaxSeconds = 9'000'000'000;

/// std::from_chars accepts no plus sign.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  return text;
}

template <typename Number>
bool parse_whole(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kAround = " \t\"\r";
  const auto first = text.find_first_not_of(kAround);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kAround) - first + 1);
}

bool parse_number(std::string_view text, double& value) {
  return parse_whole(without_plus(trimmed(text)), value);
}

bool parse_number(std::string_view text, std::int64_t& value) {
  text = without_plus(trimmed(text));
  if (parse_whole(text, value)) {
    return true;
  }
  double number = 0.0;
  constexpr double kLimit = 9.2e18;  // below 2^63
  if (!parse_whole(text, number) || !(std::abs(number) < kLimit) || number != std::trunc(number)) {
    return false;
  }
  value = static_cast<std::int64_t>(number);
  return true;
}

bool parse_seconds(std::string_view text, std::int64_t& value_ns) {
  text = without_plus(trimmed(text));
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) {
    text.remove_prefix(1);
  }
  const auto dot = text.find('.');
  const std::string_view whole = text.substr(0, dot);
  const std::string_view decimals = dot == std::string_view::npos ? std::string_view{} : text.substr(dot + 1);
  std::int64_t seconds = 0;
  if (whole.empty() || whole[0] == '-' || !parse_whole(whole, seconds) || seconds > kMaxSeconds) {
    return false;
  }
  std::int64_t fraction_ns = 0;
  std::int64_t unit_ns = kNsPerSecond / 10;
  for (const char digit : decimals) {
    if (digit < '0' || digit > '9') {
      return false;
    }
    fraction_ns += (digit - '0') * unit_ns;  // digits beyond the ninth have unit 0
    unit_ns /= 10;
  }
  value_ns = seconds * kNsPerSecond + fraction_ns;
  value_ns = negative ? -value_ns : value_ns;
  return true;
}

}  // namespace isobar::text
