// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "config/setting.hpp"
#include "config/value_text.hpp"
#include "tools/web/view_json.hpp"

namespace isobar::web {
namespace {

/// Values of all settings as texts, by key.
std::map<std::string, std::string> values_of(Config config) {
  std::map<std::string, std::string> values;
  for (const Setting& setting : settings_of(config)) values[setting.key] = value_text(setting);
  return values;
}

/// Where a value comes from, in words.
std::string source_of(const std::string& key, const std::string& value, bool is_default,
                      const LoadedConfig* from, const std::map<std::string, std::string>& in_files,
                      const std::string& unknown_source) {
  if (from != nullptr) {
    const auto origin = from->origins.find(key);
    if (origin != from->origins.end()) {
      std::string place = origin->second.file + ":" + std::to_string(origin->second.line);
      if (in_files.at(key) == value) return place;
      return place + " says " + in_files.at(key) +
             ": replaced on the command line, or changed since the start";
    }
  }
  return is_default ? "default" : unknown_source;
}

}  // namespace

nlohmann::ordered_json settings_json(const Config& in_force, const LoadedConfig* from,
                                     const std::string& unknown_source) {
  const std::map<std::string, std::string> defaults = values_of(Config{});
  const std::map<std::string, std::string> in_files =
      from == nullptr ? std::map<std::string, std::string>{} : values_of(from->config);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  Config copy = in_force;
  for (const Setting& setting : settings_of(copy)) {
    if (in_force.role == Role::kBaseStation && setting.used_by == UsedBy::kRobot) continue;
    const std::string value = value_text(setting);
    const bool is_default = value == defaults.at(setting.key);
    json.push_back({{"key", setting.key},
                    {"value", value},
                    {"unit", setting.unit},
                    {"doc", setting.doc},
                    {"basic", setting.audience == Audience::kBasic},
                    {"source", source_of(setting.key, value, is_default, from, in_files, unknown_source)},
                    {"is_default", is_default}});
  }
  return json;
}

}  // namespace isobar::web
