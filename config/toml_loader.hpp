// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/config_layer.hpp"
#include "config/problems.hpp"
#include "config/setting.hpp"
#include "config/toml_place.hpp"

namespace isobar {

/// Assigns the values of one parsed TOML file to the settings. Collects errors and places.
class TomlLoader {
 public:
  /// The arguments must outlive the object; `file` is its name in errors.
  TomlLoader(const std::string& file, const std::vector<Setting>& settings, KeyOrigins& origins)
      : file_(file), settings_(settings), origins_(origins) {}

  /// Loads a file. Errors (unknown key, wrong type, broken rule) are added in the order of their lines.
  void load(const toml::table& root, Problems& problems);

 private:
  /// An error and the line to which it belongs.
  struct Found {
    std::uint32_t line;
    std::string problem;
  };
  void load_table(const toml::table& table, const std::string& prefix);
  void load_key(const TomlPlace& place, const std::string& key);
  void load_unknown(const TomlPlace& place, const std::string& key);

  const std::string& file_;
  const std::vector<Setting>& settings_;
  KeyOrigins& origins_;
  std::vector<Found> found_;
};

}  // namespace isobar
