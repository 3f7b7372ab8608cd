// SPDX-License-Identifier: BSD-3-Clause
#include "config/value_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "core/toml_text.hpp"

namespace isobar {
namespace {

/// A number as a TOML float: with a dot or an exponent, as TOML requires.
std::string float_text(double value) {
  std::string text = number_text(value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string integer_text(int value) { return std::to_string(value); }

template <typename Numbers, typename Number>
std::string list_text(const Numbers& values, std::string (*text_of)(Number)) {
  std::string text;
  for (const Number value : values) {
    text += (text.empty() ? "" : ", ") + text_of(value);
  }
  return "[" + text + "]";
}

struct ValueText {
  const Setting& setting;

  std::string operator()(const double* value) const { return float_text(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return quoted_toml(*value); }
  std::string operator()(const Eigen::Vector3d* value) const { return list_text(*value, float_text); }
  std::string operator()(const std::vector<int>* values) const { return list_text(*values, integer_text); }
  std::string operator()(const std::vector<double>* values) const { return list_text(*values, float_text); }
  template <typename Value>
  std::string operator()(const Value* value) const {
    if constexpr (std::is_enum_v<Value>) {
      return quoted_toml(setting.choices.at(static_cast<std::size_t>(*value)));
    } else {
      return std::to_string(*value);
    }
  }
};

}  // namespace

std::string number_text(double value) {
  constexpr double kSmallestPlain = 1e-9;
  constexpr double kLargestPlain = 1e15;
  const double size = std::abs(value);
  const bool plain = value == 0.0 || (size >= kSmallestPlain && size < kLargestPlain);
  std::array<char, 40> text{};  // the longest: sign, "0.", 9 zeros, 17 digits
  const std::to_chars_result result =
      plain ? std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed)
            : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string value_text(const Setting& setting) { return std::visit(ValueText{setting}, setting.target); }

}  // namespace isobar
