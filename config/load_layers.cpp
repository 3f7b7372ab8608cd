// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <system_error>

#include "config/checksum.hpp"
#include "config/config_layer.hpp"
#include "config/problems.hpp"
#include "config/setting.hpp"
#include "config/value_text.hpp"
#include "core/printable_text.hpp"
#include "run/text/small_file.hpp"

namespace isobar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 64;

fs::path folder_of(const fs::path& main) {
  return main.has_parent_path() ? main.parent_path() : fs::path(".");
}

/// Whether `file` lies in `folder` once all links are followed; true where it does not exist.
bool is_inside(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path real_file = fs::canonical(file, error);
  if (error) return true;
  const fs::path real_folder = fs::canonical(folder, error);
  if (error) return true;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end()).first ==
         real_folder.end();
}

ConfigLayer read_layer(const fs::path& file, const fs::path& folder) {
  const std::string name = printable(file.string(), 200);
  if (!is_inside(file, folder)) {
    throw ConfigError(name + ": is a link to a file outside of " + printable(folder.string(), 200) +
                      "; a configuration must lie in its folder");
  }
  text::SmallFile read = text::read_small_file(file, text::kMostConfigBytes);
  if (!read.refusal.empty()) throw ConfigError(name + ": " + read.refusal);
  if (read.content.empty()) {
    throw ConfigError(name +
                      ": is empty, as a file is while it is written or after a power cut; a comment "
                      "line makes it a configuration with defaults");
  }
  return {name, std::move(read.content)};
}

}  // namespace

std::vector<fs::path> config_files(const fs::path& main) {
  std::vector<fs::path> files;
  const fs::path folder = folder_of(main) / kConfigFolder;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename();
    if (name.extension() == ".toml" && !name.string().starts_with('.')) files.push_back(entry->path());
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw ConfigError(printable(folder.string(), 200) + ": cannot be read: " + error.message());
  }
  if (files.size() > kMostFiles) {
    throw ConfigError(printable(folder.string(), 200) + ": holds more than " + std::to_string(kMostFiles) +
                      " *.toml files");
  }
  std::sort(files.begin(), files.end());
  files.insert(files.begin(), main);
  return files;
}

LoadedConfig load_layers(const fs::path& main) {
  Problems problems;
  std::vector<fs::path> files{main};
  problems.attempt([&] { files = config_files(main); });
  std::vector<ConfigLayer> layers;
  for (const fs::path& file : files) {
    problems.attempt([&] { layers.push_back(read_layer(file, folder_of(main))); });
  }
  LoadedConfig loaded;
  problems.attempt([&] { loaded = parse_layers(layers); });
  problems.throw_if_any();
  return loaded;
}

std::string config_hash(const Config& config) {
  constexpr std::size_t kDigits = 12;  // equal by chance once in 10^14 configurations
  Config copy = config;
  std::string values;
  for (const Setting& setting : settings_of(copy)) {
    if (config.role == Role::kBaseStation && setting.used_by == UsedBy::kRobot) continue;
    values += setting.key + " = " + value_text(setting) + "\n";
  }
  return sha256_hex(values).substr(0, kDigits);
}

}  // namespace isobar
