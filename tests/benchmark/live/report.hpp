// SPDX-License-Identifier: BSD-3-Clause
// Figures of a phase and their targets, as a table and as JSON.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/benchmark/live/arrivals.hpp"
#include "tests/benchmark/live/listeners.hpp"
#include "tests/benchmark/live/process_times.hpp"
#include "tests/benchmark/live/sender.hpp"

namespace isobar::benchmark {

/// The two measured programs.
struct Programs {
  pid_t isobard = 0;
  pid_t bridge = 0;
};

/// State at one time.
struct Reading {
  std::int64_t at_ns = 0;
  std::map<std::string, ThreadTimes> isobard, bridge;
  ResidentMemory isobard_memory, bridge_memory;
  std::map<std::string, double> health;
};
[[nodiscard]] Reading read(const Programs& programs, const MemoryListener& memory);

/// Load of one thread, or of all threads of a program.
struct Load {
  double cpu_percent = 0.0;        ///< of one core
  double turns_per_second = 0.0;   ///< time slices per second
  double mean_run_delay_ms = 0.0;  ///< from ready to running
};

struct PhaseResult {
  std::string name;
  double seconds = 0.0;
  std::size_t scans_sent = 0;
  std::size_t poses_lost = 0;  ///< scans without a pose over DDS
  Summary pose_dds;            ///< from last packet sent to pose received over DDS
  Summary pose_memory;         ///< from last packet sent to pose received through shared memory
  Summary scan_memory;         ///< from last packet sent to scan received through shared memory
  Summary prior_memory;        ///< from IMU datagram sent to prior received through shared memory
  Summary wake_up;             ///< from hand-over of a registered scan to wake-up of another process
  std::map<std::string, Load> isobard, bridge;  ///< by thread; "all": whole program
  ResidentMemory isobard_memory, bridge_memory;
  std::map<std::string, double> counts;  ///< increase of the health counters
};

[[nodiscard]] PhaseResult evaluate(const std::string& name, const Reading& before, const Reading& after,
                                   const Sender& sender, const PoseListener& poses,
                                   const MemoryListener& memory);

[[nodiscard]] std::string table(const std::vector<PhaseResult>& results);
[[nodiscard]] std::string json(const std::vector<PhaseResult>& results);
/// Real-time targets: latency of the phase, load of isobard, no dropped scan.
[[nodiscard]] bool targets_met(const std::vector<PhaseResult>& results);

}  // namespace isobar::benchmark
