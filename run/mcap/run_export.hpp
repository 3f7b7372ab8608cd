// SPDX-License-Identifier: BSD-3-Clause
// A finished run, and the recording that it was made from, as one MCAP file of ROS 2 messages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::mcap {

/// What is exported, and where to.
struct RunExport {
  std::filesystem::path run;        ///< folder of a run, with trajectory.tum
  std::filesystem::path recording;  ///< its inputs but the lidar's packets; empty: none
  std::filesystem::path out;        ///< file to create or to replace
  std::string library;              ///< program that writes, with its version
};

struct ExportedRun {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::vector<std::string> notes;  ///< what was left out, in sentences
};

/// Writes /pose, /tf, /path, /path_corrected, /altitude, /map_cloud and /scan_time of the run; /imu/data, /fluid_pressure,
/// /base/fluid_pressure, /wheel/twist and the mounts in /tf_static of the recording.
/// @param progress called with 0 … 1
/// @throws DataError naming file and rule for a broken run or recording; ServiceError for a file that cannot be written
ExportedRun export_run(const RunExport& wanted, const std::function<void(double)>& progress);

}  // namespace isobar::mcap
