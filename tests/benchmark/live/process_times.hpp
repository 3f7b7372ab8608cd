// SPDX-License-Identifier: BSD-3-Clause
// Kernel statistics of another process: processor time and run delay of each thread, resident memory.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>

namespace isobar::benchmark {

/// Sums over all threads of one name.
struct ThreadTimes {
  std::int64_t running_ns = 0;
  std::int64_t waiting_ns = 0;  ///< run delay: ready, waiting for a processor
  std::int64_t turns = 0;       ///< time slices
};

/// Times from /proc/PID/task/*/schedstat by thread name. Threads that end meanwhile are left out.
[[nodiscard]] std::map<std::string, ThreadTimes> thread_times(pid_t process);

/// Present and peak resident memory [MB]; 0 if the process has ended.
struct ResidentMemory {
  double now_mb = 0.0;
  double most_mb = 0.0;
};
[[nodiscard]] ResidentMemory resident_memory(pid_t process);

}  // namespace isobar::benchmark
