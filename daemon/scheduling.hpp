// SPDX-License-Identifier: BSD-3-Clause
// Scheduling of every thread, from [realtime] of the configuration.
#pragma once

#include "config/config.hpp"
#include "daemon/realtime.hpp"
#include "daemon/scan_queue.hpp"

namespace isobar {

/// Threads of a robot. "inertial" is the SampleThread, by the name of its configuration keys.
struct RobotScheduling {
  ThreadSettings lidar, inertial, imu, barometer, wheels, prior, registration, map, output, check, loops,
      place, floors;
};
[[nodiscard]] RobotScheduling robot_scheduling(const RealtimeSettings& realtime);

/// Threads of a base station; all have the priority of the sample thread.
struct BaseStationScheduling {
  ThreadSettings input, barometer, station;
};
[[nodiscard]] BaseStationScheduling base_station_scheduling(const RealtimeSettings& realtime);

[[nodiscard]] ScanQueueConfig scan_queue_config(const RealtimeSettings& realtime);

}  // namespace isobar
