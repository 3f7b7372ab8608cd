// SPDX-License-Identifier: BSD-3-Clause
// What the processor counts of this thread, and what the kernel counts of this process.
#pragma once

#include <cstdint>
#include <string>

namespace isobar::bench {

/// Counts since the start of the thread's counters; only differences mean something.
struct HardwareCounts {
  std::uint64_t instructions = 0;
  std::uint64_t cache_misses = 0;  ///< of the last level
};

/// Why a counter does not run: "not allowed: …", "not there: …"; empty where it does.
struct CounterRefusals {
  std::string instructions;
  std::string cache_misses;
};

/// Instructions and cache misses of the constructing thread in user space, by perf_event_open(2). Virtual
/// machines often have the one without the other.
class HardwareCounters {
 public:
  HardwareCounters();
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  [[nodiscard]] const CounterRefusals& refusals() const { return refusals_; }
  /// Zero where a counter does not run.
  [[nodiscard]] HardwareCounts read() const;

 private:
  CounterRefusals refusals_;
  int instructions_;  // files of the counters, -1: none
  int cache_misses_;
};

/// Resident memory of this process without file pages [bytes], after free memory went back to the system.
std::uint64_t resident_bytes();

}  // namespace isobar::bench
