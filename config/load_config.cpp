// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "config/config_io.hpp"
#include "config/config_layer.hpp"
#include "config/end_mark.hpp"
#include "config/problems.hpp"
#include "config/setting.hpp"
#include "config/setting_rules.hpp"
#include "config/toml_loader.hpp"
#include "run/text/bounded_toml.hpp"
#include "run/text/small_file.hpp"

namespace isobar {
namespace {

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return text::parse_bounded_toml(text, file);
  } catch (const text::TomlError& error) {
    throw ConfigError(error.at(file));
  }
}

/// "FILE:LAST LINE"
std::string end_of(const ConfigLayer& layer) {
  const auto lines = std::count(layer.text.begin(), layer.text.end(), '\n');
  return layer.file + ":" + std::to_string(lines + (layer.text.ends_with('\n') ? 0 : 1));
}

/// Loads one file into the settings.
void load_layer(const ConfigLayer& layer, const std::vector<Setting>& settings, LoadedConfig& loaded,
                Problems& problems) {
  loaded.files.push_back(layer.file);
  problems.attempt([&] {
    if (const std::string rule = broken_end_mark(layer.text); !rule.empty()) {
      throw ConfigError(end_of(layer) + ": " + rule);
    }
    const toml::table root = parse_toml(layer.text, layer.file);
    TomlLoader(layer.file, settings, loaded.origins).load(root, problems);
  });
  if (!layer.text.empty() && !layer.text.ends_with('\n')) {
    loaded.notes.push_back(end_of(layer) + ": the last line has no line end; is the file cut?");
  }
}

/// The place of a key, of the first key in a section, or of the configuration.
std::string place_of(const LoadedConfig& loaded, const std::string& key) {
  const auto at = loaded.origins.lower_bound(key);
  const bool found = at != loaded.origins.end() && (at->first == key || at->first.starts_with(key + "."));
  if (found) return at->second.place;
  return loaded.files.empty() ? "configuration" : loaded.files.front();
}

void refuse_robot_keys(const std::vector<Setting>& settings, const LoadedConfig& loaded, Problems& problems) {
  for (const auto& [key, origin] : loaded.origins) {
    const auto setting = std::find_if(settings.begin(), settings.end(),
                                      [&name = key](const Setting& s) { return s.key == name; });
    if (setting == settings.end() || setting->used_by != UsedBy::kRobot) continue;
    problems.add(origin.place + ": " + key +
                 ": is not used where role = \"base-station\", which only reads a barometer; remove it "
                 "(`isobar config show --role base-station` prints the keys that are used)");
  }
}

/// Loads the calibration file `named`, if any, into `target` and clears the name: a configuration that is
/// printed later holds the calibration itself.
void load_named_compensation(const LoadedConfig& loaded, const std::string& key, std::string& named,
                             CompensationConfig& target) {
  if (named.empty()) {
    return;
  }
  const std::string place = place_of(loaded, key) + ": " + key + ": ";
  if (target.model != CompensationModel::kNone) {
    throw ConfigError(place + "must be empty where the section [compensation] of this sensor names a model");
  }
  const std::filesystem::path config_file = loaded.origins.at(key).file;
  const std::filesystem::path path = config_file.parent_path() / named;
  if (!std::filesystem::is_regular_file(path)) {
    throw ConfigError(place + "must name a file (" + printable(path.string()) + " is none)");
  }
  target = load_compensation(path);
  named.clear();
}

/// Makes the path of a file that a key names relative to the folder of its configuration.
void resolve_path(const LoadedConfig& loaded, const std::string& key, std::string& named) {
  if (named.empty() || !loaded.origins.contains(key)) return;
  named = (std::filesystem::path(loaded.origins.at(key).file).parent_path() / named).string();
}

}  // namespace

LoadedConfig parse_layers(const std::vector<ConfigLayer>& layers) {
  LoadedConfig loaded;
  Problems problems;
  Config& config = loaded.config;
  const std::vector<Setting> settings = settings_of(config);
  for (const ConfigLayer& layer : layers) load_layer(layer, settings, loaded, problems);
  if (config.role == Role::kBaseStation) refuse_robot_keys(settings, loaded, problems);
  problems.attempt([&] {
    load_named_compensation(loaded, "barometer.compensation_file", config.barometer.compensation_file,
                            config.prior.compensation);
  });
  problems.attempt([&] {
    load_named_compensation(loaded, "base_barometer.compensation_file",
                            config.base_barometer.compensation_file, config.prior.base_compensation);
  });
  resolve_path(loaded, "lidar.calibration_file", config.lidar.calibration_file);
  check_together(
      config, [&](const std::string& key) { return place_of(loaded, key); }, problems);
  problems.throw_if_any();
  return loaded;
}

Config load_config(const std::filesystem::path& file) { return load_layers(file).config; }

Config parse_config(std::string_view text, const std::string& file) {
  return parse_layers({{file, std::string(text)}}).config;
}

CompensationConfig load_compensation(const std::filesystem::path& file) {
  const std::string name = file.string();
  const text::SmallFile read = text::read_small_file(file, text::kMostConfigBytes);
  if (!read.refusal.empty()) throw ConfigError(printable(name) + ": " + read.refusal);
  const toml::table root = parse_toml(read.content, name);
  CompensationConfig compensation;
  std::vector<Setting> settings;
  add_compensation_settings("compensation", UsedBy::kEveryRole, compensation, settings);
  Problems problems;
  KeyOrigins origins;
  TomlLoader(name, settings, origins).load(root, problems);
  problems.throw_if_any();
  if (!root.contains("compensation")) {
    throw ConfigError(name + ": has no section [compensation]");
  }
  check_compensation(compensation, name + ": compensation.");
  return compensation;
}

}  // namespace isobar
