// SPDX-License-Identifier: BSD-3-Clause
// Scheduling, affinity and memory locking.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace isobar {

/// Name, scheduling and deadline of one thread.
struct ThreadSettings {
  std::string name;          ///< as in `top -H` and the health report, at most 15 characters
  int fifo_priority = 0;     ///< SCHED_FIFO 1 … 99; 0: SCHED_OTHER
  std::vector<int> cpus{};   ///< allowed cores; empty: all
  double deadline_ms = 1e3;  ///< allowed time from input to output [ms], see Deadline
  int nice = 0;              ///< of SCHED_OTHER, 0 … 19: others go first
};

/// Applies name and scheduling to the calling thread.
/// @return empty, or what the system refused and how to allow it
[[nodiscard]] std::string apply_to_this_thread(const ThreadSettings& settings) noexcept;

/// Applies each of the settings to a thread that ends at once, so that refusals are known before the pipeline
/// starts.
/// @return one sentence for each refusal
[[nodiscard]] std::vector<std::string> try_settings(const std::vector<ThreadSettings>& settings);

/// Minor and major page faults of the calling thread since its start. One system call.
[[nodiscard]] std::uint64_t page_faults_of_this_thread() noexcept;

/// Locks all present and future pages of the process in memory.
/// @return empty, or what the system refused and how to allow it
[[nodiscard]] std::string lock_memory() noexcept;

}  // namespace isobar
