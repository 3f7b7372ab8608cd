// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/live_settings.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "tools/web/view_json.hpp"

namespace isobar::web {
namespace {

/// The files of a configuration; nothing where this user cannot read them or they have errors.
std::optional<LoadedConfig> files_of(const std::string& main) {
  if (main.empty()) return std::nullopt;
  try {
    return load_layers(main);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

nlohmann::ordered_json settings_in(const ipc::RunDescription& description) {
  constexpr std::size_t kMost = ipc::RunDescription::kMaxBytes;
  const bool has_settings = description.settings_bytes > 0 && description.manifest_bytes <= kMost &&
                            description.settings_bytes <= kMost - description.manifest_bytes;
  if (!has_settings) return nlohmann::ordered_json::array();
  const std::string main(description.configuration,
                         strnlen(description.configuration, sizeof description.configuration));
  const std::optional<LoadedConfig> files = files_of(main);
  const std::string unknown = files          ? "in none of the files: taken away since the start"
                              : main.empty() ? "unknown"
                                             : main + ", which cannot be read here";
  try {
    const Config in_force = parse_config(description.settings(), "the settings of isobard");
    return settings_json(in_force, files ? &*files : nullptr, unknown);
  } catch (const ConfigError&) {
    return nlohmann::ordered_json::array();  // of another version
  }
}

}  // namespace isobar::web
