// SPDX-License-Identifier: BSD-3-Clause
// Files in the folder of a run, whether live or replayed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace isobar::files {

inline constexpr const char* kTrajectoryFile = "trajectory.tum";  ///< pose of base_link per scan (TUM format)
inline constexpr const char* kCorrectedTrajectoryFile =
    "trajectory-corrected.tum";                           ///< the same, after the loops
inline constexpr const char* kStatusFile = "status.csv";  ///< how each pose came about: kStatusColumns
inline constexpr const char* kCovarianceFile = "covariance.csv";  ///< of each pose: kCovarianceColumns
inline constexpr const char* kMapPointsFile = "map.ply";          ///< the map's points
inline constexpr const char* kSettingsFile = "settings.toml";     ///< every setting of the run
inline constexpr const char* kCountersFile = "counters.csv";      ///< name, count, first message
inline constexpr const char* kMountsFile = "mounts.toml";         ///< mounts as found, for the configuration
inline constexpr const char* kMapDirectory = "map";               ///< the map's tiles (run/tile_store)
inline constexpr const char* kCheckpointFile = "checkpoint";      ///< where a later run goes on: Checkpoint

/// Name of a file or of a frame for a map frame: the name itself for the first one, with _2, _3 … before its
/// extension for later ones.
[[nodiscard]] inline std::string name_of_session(const std::filesystem::path& name, std::uint32_t session) {
  if (session <= 1) return name.string();
  return name.stem().string() + "_" + std::to_string(session) + name.extension().string();
}

/// True if the folder holds files of a run.
[[nodiscard]] bool holds_run(const std::filesystem::path& directory);
/// Number of the newest map frame of which the folder holds a trajectory or a map; 0 without any.
[[nodiscard]] std::uint32_t newest_session(const std::filesystem::path& directory);
/// True if the trajectory of a map frame holds no pose.
[[nodiscard]] bool has_no_pose(const std::filesystem::path& directory, std::uint32_t session);
/// Refuses a folder that is not empty and does not hold what Isobar writes there, so that nothing of others is
/// mixed with it or replaced. Hidden files, lost+found, the black box's folder and the kept configuration do not
/// count.
/// @param own a file that Isobar's folders have; empty: those of a run
/// @param key the setting that names the folder, for the error
/// @throws ConfigError naming the folder and a file in it
void refuse_foreign_folder(const std::filesystem::path& directory, const char* own, const std::string& key);
/// Deletes the files of a run, and no others.
/// @throws ServiceError naming the file that cannot be deleted
void remove_run(const std::filesystem::path& directory);

}  // namespace isobar::files
