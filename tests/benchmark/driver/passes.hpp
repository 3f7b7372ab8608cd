// SPDX-License-Identifier: BSD-3-Clause
// One pass of the system under test over a data set: cost and pose of each scan.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "run/evaluation/trajectory.hpp"
#include "tests/benchmark/driver/data_set.hpp"
#include "tests/benchmark/driver/hardware_counters.hpp"
#include "tests/benchmark/driver/system_under_test.hpp"

namespace isobar::bench {

/// Cost of one scan: CPU times, allocations, hardware counts.
struct ScanCosts {
  double decode_ms = 0.0;        ///< 0 without packets
  double registration_ms = 0.0;  ///< deskew to solve
  double map_ms = 0.0;           ///< almost 0 if the map did not insert the scan
  double hand_over_ms = 0.0;     ///< 0 unless map_changed
  bool map_changed = false;
  bool registered = false;  ///< false: the pose is the prior's, or the map is bootstrapping
  std::size_t registration_allocations = 0;
  std::size_t map_allocations = 0;
  HardwareCounts registration_counts;
  HardwareCounts map_counts;

  [[nodiscard]] double total_ms() const { return registration_ms + map_ms + hand_over_ms; }
};

/// Size of map and process during a pass.
struct MemorySample {
  std::size_t scan = 0;
  std::size_t cells = 0;
  std::size_t planes = 0;
  std::size_t tiles = 0;
  std::uint64_t resident_bytes = 0;
};

struct Pass {
  std::vector<ScanCosts> scans;
  std::vector<MemorySample> memory;  ///< before the first scan, at intervals, and after the last
  std::vector<evaluation::StampedPose> poses;
  CounterRefusals refusals;
};

/// Runs decoder, registration and map over all scans and measures each separately. `look_at_memory`: sample
/// the memory of the process. Meaningful in the first pass over a data set only (later ones reuse partly
/// freed pages); each sample disturbs the next scan.
Pass measure_pass(DataSet& data, bool look_at_memory);

/// Another pass that measures the stages of each successful registration.
std::vector<StageCosts> measure_stages(DataSet& data);

/// Pose as in a trajectory.
evaluation::StampedPose stamped(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base);

}  // namespace isobar::bench
