// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "tools/web/map_tiles.hpp"

namespace isobar::web {

/// What is on the disk, ready to be served: the JSON of /api/view; the map goes into a MapTiles.
struct FileView {
  std::string json;
  std::string summary;  ///< one line for the terminal
};

/// Called with the part that is read, 0 … 1.
using ReadProgress = std::function<void(double)>;

/// What is said of a folder that holds neither.
[[nodiscard]] inline std::string not_shown(const std::filesystem::path& folder) {
  return folder.string() + ": is neither a run (trajectory.tum) nor a recording (recording.toml)";
}

/// Reads the folder of a run, of which only the trajectory is required.
/// @throws DataError "file:line: rule" when there is no trajectory, or a file breaks its format
[[nodiscard]] FileView read_run(const std::filesystem::path& folder, MapTiles& map);

/// Reads a recording: what it holds, its pressures and inertial samples, and its reference.
/// @throws DataError "file:line: rule" when it cannot be read
[[nodiscard]] FileView read_recording(const std::filesystem::path& folder, const ReadProgress& progress);

}  // namespace isobar::web
