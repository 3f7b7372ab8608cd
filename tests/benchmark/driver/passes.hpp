// SPDX-License-Identifier: BSD-3-Clause
// One pass of the system under test over a data set: what each scan cost, and where it led.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "run/evaluation/trajectory.hpp"
#include "tests/benchmark/driver/data_set.hpp"
#include "tests/benchmark/driver/hardware_counters.hpp"
#include "tests/benchmark/driver/system_under_test.hpp"

namespace isobar::bench {

/// CPU time and more of one scan.
struct ScanCosts {
  double decode_ms = 0.0;        ///< 0 where there are no packets
  double registration_ms = 0.0;  ///< deskew to solve
  double map_ms = 0.0;           ///< 0 where the map did not want the scan, but for asking
  double hand_over_ms = 0.0;     ///< where map_changed
  bool map_changed = false;
  bool registered = false;  ///< else the pose is the prior's, or the map is being started
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
  std::vector<MemorySample> memory;  ///< before the first scan, then some, then after the last
  std::vector<evaluation::StampedPose> poses;
  CounterRefusals refusals;
};

/// Runs decoder, registration and map over all scans and measures each on its own. `look_at_memory`: see how
/// the process grows. Only the first pass over a data set can tell (what it frees goes back to the system but
/// for pages that are still in part used), and each look disturbs the next scan.
Pass measure_pass(DataSet& data, bool look_at_memory);

/// Runs them once more and splits the time of each registration by stage, for scans that were registered.
std::vector<StageCosts> measure_stages(DataSet& data);

/// A pose as trajectories have it.
evaluation::StampedPose stamped(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base);

}  // namespace isobar::bench
