// SPDX-License-Identifier: BSD-3-Clause
// Files in the folder of a run, whether live or replayed.
#pragma once

namespace isobar::files {

inline constexpr const char* kTrajectoryFile = "trajectory.tum";  ///< pose of base_link per scan (TUM format)
inline constexpr const char* kStatusFile = "status.csv";       ///< how each pose came about: kStatusColumns
inline constexpr const char* kMapPointsFile = "map.ply";       ///< the map's points: x, y, z, intensity
inline constexpr const char* kSettingsFile = "settings.toml";  ///< every setting of the run
inline constexpr const char* kCountersFile = "counters.csv";   ///< name, count, first message
inline constexpr const char* kMapDirectory = "map";            ///< the map's tiles (run/tile_store)

}  // namespace isobar::files
