// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/number_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace isobar::report {

namespace {

constexpr std::string_view kMinus = "\u2212";

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') result += c;
    }
  }
  return result;
}

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) return "\u2013";
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  std::string result(text.data());
  if (result.front() == '-' && result.find_first_not_of("-0.") == std::string::npos) result.erase(0, 1);
  return result;
}

std::string fixed_signed(double value, int decimals) {
  std::string text = fixed(value, decimals);
  if (std::isnan(value) || text.find_first_of("123456789") == std::string::npos) return text;
  if (text.front() == '-') return std::string(kMinus) + text.substr(1);
  return "+" + text;
}

}  // namespace isobar::report
