// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/scheduling.hpp"

namespace isobar {

RobotScheduling robot_scheduling(const RealtimeSettings& realtime) {
  const auto fifo = [&](int priority) { return realtime.enabled ? priority : 0; };
  return {
      {"lidar", fifo(realtime.lidar_priority), realtime.estimator_cpus, realtime.lidar_deadline_ms},
      {"inertial", fifo(realtime.inertial_priority), realtime.estimator_cpus},
      {"imu", fifo(realtime.inertial_priority), realtime.estimator_cpus},
      {"barometer", fifo(realtime.inertial_priority), realtime.estimator_cpus},
      {"wheels", fifo(realtime.inertial_priority), realtime.estimator_cpus},
      {"prior", fifo(realtime.prior_priority), realtime.estimator_cpus, realtime.prior_deadline_ms},
      {"registration", fifo(realtime.registration_priority), realtime.estimator_cpus,
       realtime.registration_deadline_ms},
      {"map", 0, realtime.map_cpus, realtime.map_deadline_ms},
      {"output", 0, {}},
      {"check", 0, realtime.map_cpus},
      {"loops", 0, realtime.map_cpus},
      {"place", 0, realtime.map_cpus},
      {"floors", 0, realtime.map_cpus, 1e3, 10},
  };
}

BaseStationScheduling base_station_scheduling(const RealtimeSettings& realtime) {
  const int priority = realtime.enabled ? realtime.inertial_priority : 0;
  return {{"input", priority, realtime.estimator_cpus},
          {"barometer", priority, realtime.estimator_cpus},
          {"station", priority, realtime.estimator_cpus}};
}

ScanQueueConfig scan_queue_config(const RealtimeSettings& realtime) {
  return {static_cast<std::int64_t>(realtime.prior_reach_ms * 1e6),
          static_cast<std::int64_t>(realtime.prior_wait_ms * 1e6)};
}

}  // namespace isobar
