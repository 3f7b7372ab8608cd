// SPDX-License-Identifier: BSD-3-Clause
// What the kernel knows of another process: the processor time of each thread, how long it waited for a
// processor, how much memory is resident.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>

namespace isobar::benchmark {

/// Of all threads of one name.
struct ThreadTimes {
  std::int64_t running_ns = 0;
  std::int64_t waiting_ns = 0;  ///< ready to run, but no processor was free
  std::int64_t turns = 0;       ///< times that it got a processor
};

/// /proc/PID/task/*/schedstat, by the threads' names. Threads that end meanwhile are left out.
[[nodiscard]] std::map<std::string, ThreadTimes> thread_times(pid_t process);

/// Resident memory now and at most [MB]; 0 where the process is gone.
struct ResidentMemory {
  double now_mb = 0.0;
  double most_mb = 0.0;
};
[[nodiscard]] ResidentMemory resident_memory(pid_t process);

}  // namespace isobar::benchmark
