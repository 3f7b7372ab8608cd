// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/setting.hpp"
#include "config/toml_place.hpp"

namespace isobar {

/// Assigns the values of a parsed TOML file to the settings.
class TomlLoader {
 public:
  /// `settings` must outlive the object; `file` is its name in errors.
  TomlLoader(std::string file, const std::vector<Setting>& settings)
      : file_(std::move(file)), settings_(settings) {}

  /// @throws ConfigError when a key is unknown, or a value has the wrong type or breaks its rule
  void load(const toml::table& root) { load(root, ""); }

  /// @throws ConfigError when load() has met a key that a base station does not use
  void refuse_robot_keys() const;

 private:
  void load(const toml::table& table, const std::string& prefix);
  void load_unknown(const TomlPlace& place, const std::string& key);

  std::string file_;
  const std::vector<Setting>& settings_;
  std::optional<TomlPlace> robot_key_;  // the first one
};

}  // namespace isobar
