// SPDX-License-Identifier: BSD-3-Clause
// The simulator: a scenario and a seed become a recording folder, as a real robot would have written it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace isobar::simulation {

/// What to simulate.
struct ScenarioRequest {
  std::string name;         ///< one of scenarios()
  std::uint64_t seed = 1;   ///< draws the world, the path and every sensor's errors
  bool short_form = false;  ///< 30 to 60 s instead of the whole run
  double stop_after_s = std::numeric_limits<double>::infinity();  ///< cuts the run short
};

/// A scenario that simulate() knows.
struct ScenarioInfo {
  std::string name;
  std::string description;
};

/// Every scenario, in the order of the paper's experiments.
[[nodiscard]] std::vector<ScenarioInfo> scenarios();

/// Writes a complete recording (recording.toml, lidar.pcap, CSV files, reference.tum, segments.csv) to
/// `out_dir`, which is created if missing. The same request gives byte-identical files on the same machine,
/// whatever the number of cores. `progress` is called with 0 … 1 from the calling thread; it may be empty.
/// Throws UsageError for an unknown scenario and DataError or ServiceError if a file cannot be written.
void simulate(const ScenarioRequest& request, const std::filesystem::path& out_dir,
              const std::function<void(double)>& progress);

}  // namespace isobar::simulation
