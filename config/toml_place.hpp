// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <toml++/toml.h>

#include <sstream>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "core/printable_text.hpp"

namespace isobar {

/// A value in a TOML file: its place, its key and the errors about it.
class TomlPlace {
 public:
  /// `file` and `node` must outlive the object.
  TomlPlace(const std::string& file, std::string key, const toml::node& node)
      : file_(file), key_(std::move(key)), node_(node) {}

  [[nodiscard]] const toml::node& node() const { return node_; }
  [[nodiscard]] std::uint32_t line() const { return node_.source().begin.line; }
  /// "FILE:LINE:COLUMN"
  [[nodiscard]] std::string text() const {
    const toml::source_position& at = node_.source().begin;
    return file_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
  }

  /// @throws ConfigError always: "file:line:column: key: rule"
  [[noreturn]] void fail(const std::string& rule) const {
    throw ConfigError(text() + ": " + printable(key_) + ": " + rule);
  }

  /// @throws ConfigError always: "file:line:column: key: rule (got VALUE)"
  [[noreturn]] void fail_with_value(const std::string& rule) const {
    fail(rule + " (got " + printable(got()) + ")");
  }

 private:
  [[nodiscard]] std::string got() const {
    std::ostringstream text;
    if (node_.is_table()) {
      text << "a section";
    } else {
      node_.visit([&text](const auto& node) { text << node; });
    }
    return text.str();
  }

  const std::string& file_;
  std::string key_;
  const toml::node& node_;
};

}  // namespace isobar
