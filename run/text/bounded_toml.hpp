// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace isobar::text {

/// A text that is refused as TOML. what(): the rule, without a place.
class TomlError : public std::runtime_error {
 public:
  TomlError(std::uint32_t line, std::uint32_t column, const std::string& rule)
      : std::runtime_error(rule), line_(line), column_(column) {}
  [[nodiscard]] std::uint32_t line() const noexcept { return line_; }
  /// "FILE:LINE:COLUMN: RULE"
  [[nodiscard]] std::string at(const std::string& file) const {
    return file + ":" + std::to_string(line_) + ":" + std::to_string(column_) + ": " + what();
  }

 private:
  std::uint32_t line_;
  std::uint32_t column_;
};

/// Parses a TOML text whose nesting is within bounds (toml_bounds.hpp).
/// @throws TomlError when it is no TOML, nested too deep or no UTF-8 text
toml::table parse_bounded_toml(std::string_view text, const std::string& file);

}  // namespace isobar::text
