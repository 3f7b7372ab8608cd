// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace isobar {

/// CPU time of the calling thread since construction.
class CpuTimer {
 public:
  CpuTimer() : started_ms_(now_ms()) {}
  [[nodiscard]] double elapsed_ms() const { return now_ms() - started_ms_; }

 private:
  static double now_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
  }
  double started_ms_;
};

}  // namespace isobar
