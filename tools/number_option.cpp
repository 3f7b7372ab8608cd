// SPDX-License-Identifier: BSD-3-Clause
#include "tools/number_option.hpp"

#include <cmath>
#include <cstdio>
#include <string>

namespace isobar::tools {

namespace {

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

template <typename Allowed>
CLI::Validator number_that(const std::string& rule, Allowed allowed) {
  const auto check = [rule, allowed](const std::string& word) -> std::string {
    double value = 0.0;
    if (!CLI::detail::lexical_cast(word, value) || !std::isfinite(value))
      return "\"" + word + "\" is no number";
    return allowed(value) ? std::string() : word + " is not " + rule;
  };
  return {check, rule, ""};
}

}  // namespace

CLI::Validator number_within(double lowest, double highest) {
  return number_that("within " + text_of(lowest) + " \u2026 " + text_of(highest),
                     [=](double value) { return value >= lowest && value <= highest; });
}

CLI::Validator number_above_zero() {
  return number_that("above 0", [](double value) { return value > 0.0; });
}

CLI::Validator number_from_zero() {
  return number_that("at least 0", [](double value) { return value >= 0.0; });
}

}  // namespace isobar::tools
