// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/hardware_counters.hpp"

#include <linux/perf_event.h>
#include <malloc.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/errors.hpp"

namespace isobar::bench {

namespace {

/// File descriptor of the counter, or -1 and the reason.
int open_counter(std::uint64_t event, std::string& refusal) {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof(attributes);
  attributes.config = event;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  const int file = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  if (file < 0) {
    const bool forbidden = errno == EACCES || errno == EPERM;
    refusal = (forbidden ? "not allowed: " : "not there: ") + std::string(std::strerror(errno));
  }
  return file;
}

std::uint64_t read_counter(int file) {
  std::uint64_t value = 0;
  return file >= 0 && ::read(file, &value, sizeof(value)) == sizeof(value) ? value : 0;
}

}  // namespace

HardwareCounters::HardwareCounters()
    : instructions_(open_counter(PERF_COUNT_HW_INSTRUCTIONS, refusals_.instructions)),
      cache_misses_(open_counter(PERF_COUNT_HW_CACHE_MISSES, refusals_.cache_misses)) {}

HardwareCounters::~HardwareCounters() {
  for (const int file : {instructions_, cache_misses_}) {
    if (file >= 0) close(file);
  }
}

HardwareCounts HardwareCounters::read() const {
  return {read_counter(instructions_), read_counter(cache_misses_)};
}

std::uint64_t resident_bytes() {
  malloc_trim(0);
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0;
  std::uint64_t resident = 0;
  std::uint64_t of_files = 0;
  if (!(statm >> total >> resident >> of_files)) throw ServiceError("/proc/self/statm: cannot be read");
  return (resident - of_files) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace isobar::bench
