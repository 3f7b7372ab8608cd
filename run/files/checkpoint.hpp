// SPDX-License-Identifier: BSD-3-Clause
// Checkpoint of a live run: where the next start of isobard goes on.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/altitude/height_datum.hpp"

namespace isobar::files {

/// Names of the base stations of a height datum: those of the configuration. Empty: not known.
using StationNames = std::array<std::string, HeightDatum::kStations>;

/// Where a run was.
struct Checkpoint {
  std::uint32_t session = 1;  ///< number of the map frame, 1 …
  std::int64_t stamp_ns = 0;  ///< of the pose, robot clock
  std::int64_t clock_ns = 0;  ///< robot clock when it was written
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d v_map_m_s = Eigen::Vector3d::Zero();  ///< velocity, from the last poses
  double yaw_rate_rad_s = 0.0;                          ///< the same
  double overlap = 0.0;                                 ///< of the last registered pose; 0: none yet
  double residual_rms_m = 0.0;                          ///< the same
  HeightDatum datum;
  StationNames stations;  ///< of datum.station_offset_log; at most kMostStationBytes
};

/// Format: magic, version, length, fields (little-endian), CRC-32 of all bytes before it; then the names of the base stations
/// with a CRC-32 of their own. Version 1 had no names, and is read.
inline constexpr std::size_t kCheckpointBytes = 352;
inline constexpr std::size_t kMostStationBytes = 63;
using CheckpointBytes = std::array<std::byte, kCheckpointBytes>;

/// Longer names are cut.
[[nodiscard]] CheckpointBytes encode(const Checkpoint& checkpoint);
/// @return nothing where length, magic, version, checksum or a value is wrong; `rule` then says which
[[nodiscard]] std::optional<Checkpoint> decode(std::span<const std::byte> bytes, const char*& rule);

/// Replaces the file as a whole.
/// @throws ServiceError naming the file when it cannot be written; the old checkpoint stays
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// Reads the file; nothing when there is none.
/// @throws DataError "file: rule" when it cannot be read or is damaged
[[nodiscard]] std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

/// The folder in which a map's folder lies: that of its run.
[[nodiscard]] std::filesystem::path run_folder_of(const std::filesystem::path& map_folder);
/// The checkpoint of a map: in its folder, or beside it in that of its run, where it is of this map frame. Nothing where there
/// is none.
/// @throws DataError for a damaged checkpoint
[[nodiscard]] std::optional<Checkpoint> checkpoint_of_map(const std::filesystem::path& map_folder);

}  // namespace isobar::files
