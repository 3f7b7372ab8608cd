// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

/// Result of a replay.
struct ReplaySummary {
  std::uint64_t scans = 0;
  std::uint64_t poses = 0;
  std::uint64_t registered = 0;
  std::uint64_t from_prior = 0;
  std::uint64_t map_points = 0;
  std::uint64_t loops = 0;  ///< places seen again that correct the trajectory
  double recorded_s = 0.0;  ///< time from the first to the last sample
  double wall_s = 0.0;
  std::string base_clock;  ///< how the base station's clock was aligned with the robot's; empty: no base
  std::vector<std::string> warnings;  ///< about the manifest, and about what the run could not use
  std::vector<files::RunCount> counts;
};

/// Runs the pipeline in lock step over a recording and writes the folder of the run (run_output.hpp).
/// @param progress called with 0 … 1
/// @throws DataError for a recording that cannot be used; ConfigError; ServiceError when the disk refuses
ReplaySummary replay(const std::filesystem::path& recording, const Config& config,
                     const std::filesystem::path& out, const std::function<void(double)>& progress);

}  // namespace isobar
