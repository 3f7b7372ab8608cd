// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/settings_source.hpp"

#include <spdlog/spdlog.h>

#include <cstring>
#include <utility>

#include "config/config_io.hpp"
#include "config/kept_config.hpp"
#include "config/problems.hpp"
#include "core/errors.hpp"
#include "daemon/service_folder.hpp"

namespace isobar::bridge {
namespace {

std::string_view name_in(const ipc::RunDescription& isobard) {
  return {isobard.configuration, strnlen(isobard.configuration, sizeof isobard.configuration)};
}

/// Lengths come from another process.
bool has_settings(const ipc::RunDescription& isobard) {
  constexpr std::size_t kMost = ipc::RunDescription::kMaxBytes;
  return isobard.settings_bytes > 0 && isobard.manifest_bytes <= kMost &&
         isobard.settings_bytes <= kMost - isobard.manifest_bytes;
}

Settings settings_in(const Options& options, const ipc::RunDescription& isobard) {
  return settings_of(parse_config(isobard.settings(), "the settings of isobard"), options);
}

/// What isobard has kept of this configuration; nothing: it has kept none that can be used.
std::optional<Config> kept_config(const std::string& main) {
  const std::filesystem::path state = service_folder("STATE_DIRECTORY");
  if (state.empty()) return std::nullopt;
  try {
    auto kept = read_kept_config(state / kKeptConfigFile, main);
    if (kept) return std::move(kept->config);
  } catch (const ConfigError& error) {
    spdlog::warn("the kept configuration is not used: {}", error.what());
  }
  return std::nullopt;
}

Settings first_settings(const Options& options) {
  try {
    return load_settings(options);
  } catch (const ConfigErrors& errors) {
    const auto kept = kept_config(options.config_file);
    if (!kept) throw;
    for (const std::string& problem : errors.all()) spdlog::error("configuration refused: {}", problem);
    spdlog::warn("the configuration that isobard has kept is in force");
    return settings_of(*kept, options);
  }
}

}  // namespace

SettingsSource::SettingsSource(const Options& options)
    : options_(options),
      name_(options.config_file.empty() ? "" : config_identity(options.config_file)),
      settings_(first_settings(options)) {}

SettingsSource::SettingsSource(const Options& options, const ipc::RunDescription& isobard)
    : options_(options), name_(options.config_file.empty() ? "" : config_identity(options.config_file)) {
  if (!is_ours(isobard)) throw ConfigError(name_ + ": is not the configuration with which isobard runs");
  if (!has_settings(isobard)) throw ConfigError("isobard does not say its settings");
  settings_ = settings_in(options, isobard);
  follows_ = true;
}

// A bridge without a file has no settings of its own.
bool SettingsSource::is_ours(const ipc::RunDescription& isobard) const {
  return name_.empty() || name_ == name_in(isobard);
}

bool SettingsSource::follow(const ipc::RunDescription& isobard) {
  if (!is_ours(isobard)) {
    say_once("isobard runs with another configuration file; this program uses its own, " + name_);
    return false;
  }
  try {
    if (!has_settings(isobard)) throw ConfigError("they are too long for shared memory");
    const bool changed = take(settings_in(options_, isobard));
    follows_ = true;
    if (changed) spdlog::info("takes the settings that isobard has in force");
    return changed;
  } catch (const ConfigError& error) {
    say_once(std::string("the settings of isobard cannot be taken, the former ones stay in force: ") +
             error.what());
    return false;
  }
}

bool SettingsSource::reload() {
  if (follows_) return false;
  try {
    const bool changed = take(load_settings(options_));
    if (changed) spdlog::info("takes the changed settings of {}", name_);
    return changed;
  } catch (const ConfigErrors& errors) {
    for (const std::string& problem : errors.all()) spdlog::error("configuration refused: {}", problem);
  } catch (const Error& error) {
    spdlog::error("configuration refused: {}", error.what());
  }
  spdlog::warn("the former configuration stays in force");
  return false;
}

bool SettingsSource::take(Settings settings) {
  if (settings.values == settings_.values) return false;
  settings_ = std::move(settings);
  return true;
}

void SettingsSource::say_once(const std::string& line) {
  if (std::exchange(said_, line) != line) spdlog::warn("{}", line);
}

}  // namespace isobar::bridge
