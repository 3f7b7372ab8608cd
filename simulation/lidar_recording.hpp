// SPDX-License-Identifier: BSD-3-Clause
// The part of a recording that depends on the lidar: its packets, its entry in recording.toml, its calibration.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "run/recording/manifest.hpp"
#include "run/recording/recording_writer.hpp"
#include "simulation/lidar_model.hpp"
#include "simulation/lidar_plan.hpp"

namespace isobar::simulation {

/// Part of a run that is recorded.
struct LidarSpan {
  double start_s = 0.0;
  double end_s = 0.0;
};

/// Names model, ports and calibration file in the entry.
void describe_lidar(const LidarPlan& plan, recording::LidarEntry& entry);

/// Writes the calibration file that describe_lidar() has named; none for models without.
/// @throws DataError when it cannot be written
void write_lidar_calibration(const LidarPlan& plan, const std::filesystem::path& folder);

/// Simulates the packets on all cores and writes them in order. A packet depends on its number alone.
/// @param stamp_ns the host's clock at a true time [s]
/// @param progress called with 0 … 1 from the calling thread; may be empty
void write_lidar_packets(const LidarPlan& plan, const LidarModel& lidar, const LidarSpan& span,
                         const std::function<std::int64_t(double)>& stamp_ns,
                         recording::RecordingWriter& writer, const std::function<void(double)>& progress);

}  // namespace isobar::simulation
