// SPDX-License-Identifier: BSD-3-Clause
// Scheduling, affinity and memory locking of a thread of the pipeline.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace isobar {

/// How one thread of the pipeline is scheduled, and when it is late.
struct ThreadSettings {
  std::string name;          ///< as `top -H` shows it, 15 characters at most
  int fifo_priority = 0;     ///< SCHED_FIFO 1 … 99; 0 leaves the thread to the ordinary scheduler
  std::vector<int> cpus{};   ///< cores that it may run on; empty: all
  double deadline_ms = 1e3;  ///< from what it takes to what it makes; later is counted, see Deadline
};

/// Applies the settings to the calling thread. Returns an empty string, or what was refused and how to allow
/// it (a robot still drives without real-time rights; the health report says so).
[[nodiscard]] std::string apply_to_this_thread(const ThreadSettings& settings) noexcept;

/// Applies each of the settings to a thread that ends at once; returns what was refused. A thread of the
/// pipeline then meets no surprise.
[[nodiscard]] std::vector<std::string> try_settings(const std::vector<ThreadSettings>& settings);

/// Page faults of the calling thread so far, minor and major. One system call.
[[nodiscard]] std::uint64_t page_faults_of_this_thread() noexcept;

/// Keeps all present and future pages of the process in memory. Returns an empty string or what was refused.
[[nodiscard]] std::string lock_memory() noexcept;

}  // namespace isobar
