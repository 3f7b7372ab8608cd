// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/device/device.hpp"

namespace isobar {

/// Interval of the health report [ns]; a fault or recovery of the barometer is reported at once.
inline constexpr std::int64_t kReportEveryNs = 1'000'000'000;

/// Decides when a health report is due: every second, and when the state of the barometer changes. The first
/// report is due one second after the first call, by which time every working sensor has sent. One thread.
class ReportSchedule {
 public:
  [[nodiscard]] bool due(std::int64_t now_ns, DeviceState barometer) {
    if (!started_) {
      started_ = true;
      last_ns_ = now_ns;
    }
    const bool changed = reported_ && barometer != barometer_;
    if (now_ns - last_ns_ < kReportEveryNs && !changed) return false;
    reported_ = true;
    last_ns_ = now_ns;
    barometer_ = barometer;
    return true;
  }

 private:
  std::int64_t last_ns_ = 0;
  DeviceState barometer_{};
  bool started_ = false;
  bool reported_ = false;
};

}  // namespace isobar
