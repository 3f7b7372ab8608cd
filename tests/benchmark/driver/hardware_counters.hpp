// SPDX-License-Identifier: BSD-3-Clause
// Hardware counters of this thread, and resident memory of this process.
#pragma once

#include <cstdint>
#include <string>

namespace isobar::bench {

/// Counts since an arbitrary start: use differences.
struct HardwareCounts {
  std::uint64_t instructions = 0;
  std::uint64_t cache_misses = 0;  ///< last-level cache
};

/// Reason why a counter is not available: "not allowed: …", "not there: …"; empty if it runs.
struct CounterRefusals {
  std::string instructions;
  std::string cache_misses;
};

/// Instructions and cache misses of the constructing thread in user space (perf_event_open(2)). Virtual
/// machines often have only one of them.
class HardwareCounters {
 public:
  HardwareCounters();
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  [[nodiscard]] const CounterRefusals& refusals() const { return refusals_; }
  /// Zero for a counter that is not available.
  [[nodiscard]] HardwareCounts read() const;

 private:
  CounterRefusals refusals_;
  int instructions_;  // file descriptors of the counters; -1: none
  int cache_misses_;
};

/// Resident memory of this process without file pages [bytes], after returning free memory to the system.
std::uint64_t resident_bytes();

}  // namespace isobar::bench
