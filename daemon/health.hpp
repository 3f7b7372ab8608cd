// SPDX-License-Identifier: BSD-3-Clause
// The health of isobard in sentences: is every sensor alive, does everything keep up, what was refused.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/inertial_thread.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/lidar_thread.hpp"
#include "daemon/map_thread.hpp"
#include "daemon/prior_thread.hpp"
#include "daemon/registration_thread.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// What all threads said of themselves at one moment.
struct StatusSnapshot {
  std::int64_t now_ns = 0;  ///< robot clock
  LidarStatus lidar;
  InertialStatus inertial;
  BarometerThreadStatus barometer;
  PriorStatus prior;
  RegistrationStatus registration;
  MapStatus map;
};

/// Turns what the threads say into a report, about once a second. Rates are against the call before.
class HealthMonitor {
 public:
  HealthMonitor(const Config& config, std::vector<std::string> realtime_refusals);

  void fill(const StatusSnapshot& now, ipc::HealthReport& report);
  /// True once a second, the first time a second after the first call; later also at once when the barometer
  /// of this machine fails or comes back.
  [[nodiscard]] bool due(const StatusSnapshot& now);

  /// Entries whose level changed since the last call, for the log: "imu: ok: 200.0 per second". At the first
  /// call sensors that are well are news, too.
  [[nodiscard]] std::vector<std::string> news(const ipc::HealthReport& report);

 private:
  void fill_lidar(const StatusSnapshot& now, double elapsed_s, ipc::HealthReport& report) const;
  void fill_samples(const StatusSnapshot& now, double elapsed_s, ipc::HealthReport& report) const;
  void fill_base_stations(const StatusSnapshot& now, ipc::HealthReport& report) const;
  static void fill_faults(const StatusSnapshot& now, ipc::HealthReport& report);
  void fill_estimate(const StatusSnapshot& now, ipc::HealthReport& report) const;
  void fill_deadlines(const StatusSnapshot& now, ipc::HealthReport& report) const;

  Config config_;
  std::vector<std::string> refusals_;
  StatusSnapshot last_;
  LevelChanges changes_;
  std::int64_t first_look_ns_ = 0;
};

}  // namespace isobar
