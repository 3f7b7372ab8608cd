// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "drivers/device/device.hpp"

namespace isobar {

/// States of the sensors that this machine reads: barometer, IMU, wheels.
using DeviceStates = std::array<DeviceState, 3>;

/// Interval of the health report [ns]; a fault or recovery of such a sensor, and of the lidar, is reported at once.
inline constexpr std::int64_t kReportEveryNs = 1'000'000'000;

/// Decides when a health report is due: every second, and when the state of a sensor changes that this machine
/// reads, or the lidar falls silent or is back. The first report is due one second after the first call, by which
/// time every working sensor has sent. One thread.
class ReportSchedule {
 public:
  [[nodiscard]] bool due(std::int64_t now_ns, const DeviceStates& states, bool lidar_silent = false) {
    if (!started_) {
      started_ = true;
      last_ns_ = now_ns;
    }
    const bool changed = reported_ && (states != states_ || lidar_silent != lidar_silent_);
    if (now_ns - last_ns_ < kReportEveryNs && !changed) return false;
    reported_ = true;
    last_ns_ = now_ns;
    states_ = states;
    lidar_silent_ = lidar_silent;
    return true;
  }

 private:
  std::int64_t last_ns_ = 0;
  DeviceStates states_{};
  bool lidar_silent_ = false;
  bool started_ = false;
  bool reported_ = false;
};

}  // namespace isobar
