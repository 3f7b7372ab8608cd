// SPDX-License-Identifier: BSD-3-Clause
#include <toml++/toml.h>

#include <fstream>
#include <sstream>

#include "config/config_io.hpp"
#include "config/setting.hpp"
#include "config/setting_rules.hpp"
#include "config/toml_loader.hpp"
#include "core/errors.hpp"

namespace isobar {
namespace {

std::string read_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    throw ConfigError(file.string() + ": no such file");
  }
  if (std::filesystem::is_directory(file)) {
    throw ConfigError(file.string() + ": is a folder, must be a TOML file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw ConfigError(file.string() + ": cannot be read");
  }
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw ConfigError(place_text(file, error.source().begin) +
                      ": is no TOML: " + std::string(error.description()));
  }
}

/// Loads the calibration file `named`, if any, into `target` and clears the name: a configuration that is
/// printed later holds the calibration itself.
void load_named_compensation(const std::string& config_file, const char* key, std::string& named,
                             CompensationConfig& target) {
  if (named.empty()) {
    return;
  }
  const std::string place = config_file + ": " + key + ": ";
  if (target.model != CompensationModel::kNone) {
    throw ConfigError(place + "must be empty where the section [compensation] of this sensor names a model");
  }
  const std::filesystem::path path = std::filesystem::path(config_file).parent_path() / named;
  if (!std::filesystem::is_regular_file(path)) {
    throw ConfigError(place + "must name a file (" + path.string() + " is none)");
  }
  target = load_compensation(path);
  named.clear();
}

}  // namespace

Config load_config(const std::filesystem::path& file) { return parse_config(read_file(file), file.string()); }

Config parse_config(std::string_view text, const std::string& file) {
  const toml::table root = parse_toml(text, file);
  Config config;
  const std::vector<Setting> settings = settings_of(config);
  TomlLoader loader(file, settings);
  loader.load(root);
  if (config.role == Role::kBaseStation) loader.refuse_robot_keys();
  load_named_compensation(file, "barometer.compensation_file", config.barometer.compensation_file,
                          config.prior.compensation);
  load_named_compensation(file, "base_barometer.compensation_file", config.base_barometer.compensation_file,
                          config.prior.base_compensation);
  check_together(config, file);
  return config;
}

CompensationConfig load_compensation(const std::filesystem::path& file) {
  const std::string name = file.string();
  const toml::table root = parse_toml(read_file(file), name);
  CompensationConfig compensation;
  std::vector<Setting> settings;
  add_compensation_settings("compensation", UsedBy::kEveryRole, compensation, settings);
  TomlLoader(name, settings).load(root);
  if (!root.contains("compensation")) {
    throw ConfigError(name + ": has no section [compensation]");
  }
  check_compensation(compensation, name + ": compensation.");
  return compensation;
}

}  // namespace isobar
