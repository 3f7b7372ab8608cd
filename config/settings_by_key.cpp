// SPDX-License-Identifier: BSD-3-Clause
#include "config/settings_by_key.hpp"

#include "config/setting.hpp"
#include "config/value_text.hpp"

namespace isobar {

std::map<std::string, std::string> settings_by_key(const Config& config) {
  Config copy = config;  // the table points into one
  std::map<std::string, std::string> values;
  for (const Setting& setting : settings_of(copy)) {
    if (config.role == Role::kBaseStation && setting.used_by == UsedBy::kRobot) continue;
    values[setting.key] = value_text(setting);
  }
  return values;
}

}  // namespace isobar
