// SPDX-License-Identifier: BSD-3-Clause
#include "config/toml_loader.hpp"

#include <algorithm>

#include "config/assign_value.hpp"
#include "config/nearest_key.hpp"

namespace isobar {

void TomlLoader::load(const toml::table& table, const std::string& prefix) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    const TomlPlace place(file_, key, node);
    const auto found = std::find_if(settings_.begin(), settings_.end(),
                                    [&key](const Setting& setting) { return setting.key == key; });
    if (found == settings_.end()) {
      load_unknown(place, key);
      continue;
    }
    assign_value(*found, place);
    if (found->used_by == UsedBy::kRobot && !robot_key_) robot_key_.emplace(place);
  }
}

/// Handles a key that is not in the settings table: a section, or an error.
void TomlLoader::load_unknown(const TomlPlace& place, const std::string& key) {
  const bool is_section = std::any_of(settings_.begin(), settings_.end(), [&key](const Setting& setting) {
    return setting.key.starts_with(key + ".");
  });
  if (!is_section) {
    const std::string nearest = nearest_key(settings_, key);
    place.fail(nearest.empty() ? "unknown key" : "unknown key; did you mean " + nearest + "?");
  }
  if (!place.node().is_table()) {
    place.fail("must be a section, [" + key + "]");
  }
  load(*place.node().as_table(), key + ".");
}

void TomlLoader::refuse_robot_keys() const {
  if (robot_key_) {
    robot_key_->fail(
        "is not used where role = \"base-station\", which only reads a barometer; remove it "
        "(`isobar config show --role base-station` prints the keys that are used)");
  }
}

}  // namespace isobar
