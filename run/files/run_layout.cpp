// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/run_layout.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/errors.hpp"
#include "run/tile_store/map_folder.hpp"

namespace isobar::files {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 6> kOfSession{kTrajectoryFile, kCorrectedTrajectoryFile, kStatusFile,
                                                kCovarianceFile, kMapPointsFile,           kMapDirectory};
constexpr std::array<const char*, 4> kOfRun{kSettingsFile, kCountersFile, kCheckpointFile, kMountsFile};

/// Number of the map frame to which a file belongs; 0 for a file of none.
std::uint32_t session_of(const std::string& file, const fs::path& first) {
  if (file == first.string()) return 1;
  const std::string begin = first.stem().string() + "_";
  const std::string end = first.extension().string();
  if (!file.starts_with(begin) || !file.ends_with(end) || file.size() <= begin.size() + end.size()) return 0;
  std::uint32_t number = 0;
  const char* stop = file.data() + file.size() - end.size();
  const auto [at, error] = std::from_chars(file.data() + begin.size(), stop, number);
  return error == std::errc{} && at == stop && number > 1 ? number : 0;
}

std::vector<std::string> names_in(const fs::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(directory, error), end; !error && at != end; at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Whether a file may lie beside those of a run: isobard's own in its state folder, and the file system's.
bool is_beside_runs(std::string_view name) {
  return name == "lost+found" || name == "lock" || name == "blackbox" || name.starts_with("last-good.toml");
}

bool is_of_run(const std::string& name) {
  const auto equal = [&](const char* own) { return name == own; };
  const auto numbered = [&](const char* own) { return session_of(name, own) > 0; };
  return std::any_of(kOfRun.begin(), kOfRun.end(), equal) ||
         std::any_of(kOfSession.begin(), kOfSession.end(), numbered);
}

}  // namespace

bool holds_run(const fs::path& directory) {
  const std::vector<std::string> names = names_in(directory);
  return std::any_of(names.begin(), names.end(), is_of_run);
}

std::uint32_t newest_session(const fs::path& directory) {
  std::uint32_t newest = 0;
  for (const std::string& name : names_in(directory)) {
    for (const char* own : kOfSession) newest = std::max(newest, session_of(name, own));
  }
  return newest;
}

bool has_no_pose(const fs::path& directory, std::uint32_t session) {
  std::ifstream lines(directory / name_of_session(kTrajectoryFile, session));
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.starts_with('#')) return false;
  }
  return true;
}

void refuse_foreign_folder(const fs::path& directory, const char* own, const std::string& key) {
  std::error_code error;
  if (fs::exists(directory, error) && !fs::is_directory(directory, error)) {
    throw ConfigError(key + ": " + directory.string() + " is not a folder");
  }
  const std::vector<std::string> names = names_in(directory);
  const bool is_own = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::string_view(own).empty() ? is_of_run(name) : name == own;
  });
  if (is_own) return;
  for (const std::string& name : names) {
    if (name.starts_with('.') || is_beside_runs(name)) continue;
    std::string rule = key + ": " + directory.string() + " holds files of others (";
    rule += name + "); name a new or empty folder, or one that isobard has written";
    throw ConfigError(rule);
  }
}

void remove_run(const fs::path& directory) {
  for (const std::string& name : names_in(directory)) {
    if (!is_of_run(name)) continue;
    std::error_code error;
    const fs::path file = directory / name;
    if (!fs::is_directory(file, error)) {
      fs::remove(file, error);
    } else if (fs::exists(file / "map.toml", error)) {
      const MapLock lock(file);
      remove_map(file);
    }
    if (error) throw ServiceError(file.string() + ": cannot be removed: " + error.message());
  }
}

}  // namespace isobar::files
