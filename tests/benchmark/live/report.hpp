// SPDX-License-Identifier: BSD-3-Clause
// The figures of a phase, their targets, as a table and as JSON.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/benchmark/live/arrivals.hpp"
#include "tests/benchmark/live/listeners.hpp"
#include "tests/benchmark/live/process_times.hpp"
#include "tests/benchmark/live/sender.hpp"

namespace isobar::benchmark {

/// The two programs that are measured.
struct Programs {
  pid_t isobard = 0;
  pid_t bridge = 0;
};

/// What is known at one moment.
struct Reading {
  std::int64_t at_ns = 0;
  std::map<std::string, ThreadTimes> isobard, bridge;
  ResidentMemory isobard_memory, bridge_memory;
  std::map<std::string, double> health;
};
[[nodiscard]] Reading read(const Programs& programs, const MemoryListener& memory);

/// Of one thread, or of all threads of a program.
struct Load {
  double cpu_percent = 0.0;        ///< of one core
  double turns_per_second = 0.0;   ///< times that it got a processor
  double mean_run_delay_ms = 0.0;  ///< from ready to running
};

struct PhaseResult {
  std::string name;
  double seconds = 0.0;
  std::size_t scans_sent = 0;
  std::size_t poses_lost = 0;                   ///< scans whose pose never came over DDS
  Summary pose_dds;                             ///< last packet sent to pose received over DDS
  Summary pose_memory;                          ///< … to pose received through shared memory
  Summary scan_memory;                          ///< … to scan received through shared memory
  Summary prior_memory;                         ///< IMU datagram sent to prior received through shared memory
  Summary wake_up;                              ///< registered scan handed over to another process awake
  std::map<std::string, Load> isobard, bridge;  ///< by thread; "all" is the program
  ResidentMemory isobard_memory, bridge_memory;
  std::map<std::string, double> counts;  ///< health entries that count, how much they grew
};

[[nodiscard]] PhaseResult evaluate(const std::string& name, const Reading& before, const Reading& after,
                                   const Sender& sender, const PoseListener& poses,
                                   const MemoryListener& memory);

[[nodiscard]] std::string table(const std::vector<PhaseResult>& results);
[[nodiscard]] std::string json(const std::vector<PhaseResult>& results);
/// The targets of real time: latency of the phase, load of isobard, no scan dropped.
[[nodiscard]] bool targets_met(const std::vector<PhaseResult>& results);

}  // namespace isobar::benchmark
