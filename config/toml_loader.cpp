// SPDX-License-Identifier: BSD-3-Clause
#include "config/toml_loader.hpp"

#include <algorithm>

#include "config/assign_value.hpp"
#include "config/nearest_key.hpp"
#include "config/retired_words.hpp"

namespace isobar {

void TomlLoader::load(const toml::table& root, Problems& problems) {
  load_table(root, "");
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& a, const Found& b) { return a.line < b.line; });
  for (Found& found : found_) problems.add(std::move(found.problem));
  found_.clear();
}

void TomlLoader::load_table(const toml::table& table, const std::string& prefix) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    const TomlPlace place(file_, key, node);
    try {
      load_key(place, key);
    } catch (const ConfigError& error) {
      found_.push_back({place.line(), error.what()});
    }
  }
}

void TomlLoader::load_key(const TomlPlace& place, const std::string& key) {
  const auto found = std::find_if(settings_.begin(), settings_.end(),
                                  [&key](const Setting& setting) { return setting.key == key; });
  if (found == settings_.end()) {
    load_unknown(place, key);
    return;
  }
  assign_value(*found, place);
  origins_[key] = {file_, place.line(), place.text()};
}

/// Handles a key that is not in the settings table: a section, or an error.
void TomlLoader::load_unknown(const TomlPlace& place, const std::string& key) {
  const bool is_section = std::any_of(settings_.begin(), settings_.end(), [&key](const Setting& setting) {
    return setting.key.starts_with(key + ".");
  });
  if (!is_section) {
    if (const auto remedy = retired_remedy(key); !remedy.empty()) place.fail(std::string(remedy));
    const std::string nearest = nearest_key(settings_, key);
    place.fail(nearest.empty() ? "unknown key" : "unknown key; did you mean " + nearest + "?");
  }
  if (!place.node().is_table()) {
    place.fail("must be a section, [" + key + "]");
  }
  load_table(*place.node().as_table(), key + ".");
}

}  // namespace isobar
