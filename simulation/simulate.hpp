// SPDX-License-Identifier: BSD-3-Clause
// Simulator: turns a scenario and a seed into a recording folder like that of a real robot.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "simulation/deviations.hpp"

namespace isobar::simulation {

inline constexpr const char* kUsualLidar = "VLP-16";

/// Arguments of simulate().
struct ScenarioRequest {
  std::string name;         ///< one of scenarios()
  std::uint64_t seed = 1;   ///< random seed of world, path and sensor errors
  bool short_form = false;  ///< a reduced run of 30 to 60 s
  double stop_after_s = std::numeric_limits<double>::infinity();  ///< ends the recording at this time
  Deviations deviations{};          ///< faults asked for, besides the usual errors
  std::string lidar = kUsualLidar;  ///< model, as in lidar.model
  /// Another session on the same site, by the same robot and base station: other noise, turn-on errors of IMU and wheels,
  /// weather, time, and furniture; 0: the first one.
  std::uint64_t session_seed = 0;
};

/// Name and description of a scenario.
struct ScenarioInfo {
  std::string name;
  std::string description;
  bool is_long = false;  ///< an hour or gigabytes: not part of a survey of all scenarios
};

/// All scenarios, those of the paper's experiments first.
[[nodiscard]] std::vector<ScenarioInfo> scenarios();

/// Name of the recording of a request, for files: "SCENARIO-SEED", with "-short", any lidar but a VLP-16, and the
/// deviations.
[[nodiscard]] std::string recording_name(const ScenarioRequest& request);

/// Writes a complete recording (recording.toml, lidar.pcap, CSV files, reference.tum, segments.csv, surfaces.stl, an
/// Ouster's metadata) to `out_dir`, which is created if missing. The manifest holds the mounts that the robot believes; its
/// description the deviations and the true mounts. On one machine, the same request gives byte-identical files,
/// independent of the number of cores. `progress` is called with 0 … 1 from the calling thread; it may be
/// empty.
/// @throws UsageError when scenario or lidar is unknown; it lists the known ones
/// @throws DataError when the folder cannot take a recording
/// @throws ServiceError when a file cannot be written
void simulate(const ScenarioRequest& request, const std::filesystem::path& out_dir,
              const std::function<void(double)>& progress);

}  // namespace isobar::simulation
