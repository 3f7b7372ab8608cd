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

/// What a replay did.
struct ReplaySummary {
  std::uint64_t scans = 0;
  std::uint64_t poses = 0;
  std::uint64_t registered = 0;
  std::uint64_t from_prior = 0;
  std::uint64_t map_points = 0;
  double recorded_s = 0.0;  ///< span of the samples
  double wall_s = 0.0;
  std::string base_clock;  ///< how the base station's clock was tied to the robot's; empty: no base
  std::vector<std::string> warnings;  ///< of the manifest, and of what the run could not do
  std::vector<files::RunCount> counts;
};

/// Runs the pipeline in lock step over a recording and writes the folder of the run (run_output.hpp).
/// `progress` gets 0 … 1. Throws DataError, ConfigError, ServiceError.
ReplaySummary replay(const std::filesystem::path& recording, const Config& config,
                     const std::filesystem::path& out, const std::function<void(double)>& progress);

}  // namespace isobar
