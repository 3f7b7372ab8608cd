// SPDX-License-Identifier: BSD-3-Clause
// Simulator: turns a scenario and a seed into a recording folder like that of a real robot.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace isobar::simulation {

/// Arguments of simulate().
struct ScenarioRequest {
  std::string name;         ///< one of scenarios()
  std::uint64_t seed = 1;   ///< random seed of world, path and sensor errors
  bool short_form = false;  ///< a reduced run of 30 to 60 s
  double stop_after_s = std::numeric_limits<double>::infinity();  ///< ends the recording at this time
};

/// Name and description of a scenario.
struct ScenarioInfo {
  std::string name;
  std::string description;
};

/// All scenarios, those of the paper's experiments first.
[[nodiscard]] std::vector<ScenarioInfo> scenarios();

/// Writes a complete recording (recording.toml, lidar.pcap, CSV files, reference.tum, segments.csv) to
/// `out_dir`, which is created if missing. On one machine, the same request gives byte-identical files,
/// independent of the number of cores. `progress` is called with 0 … 1 from the calling thread; it may be
/// empty.
/// @throws UsageError when the scenario is unknown
/// @throws DataError when the folder cannot take a recording
/// @throws ServiceError when a file cannot be written
void simulate(const ScenarioRequest& request, const std::filesystem::path& out_dir,
              const std::function<void(double)>& progress);

}  // namespace isobar::simulation
