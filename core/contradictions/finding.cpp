// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/finding.hpp"

namespace isobar {

namespace {

void leave_out(CheckedSensor sensor, UsableSensors& usable) {
  switch (sensor) {
    case CheckedSensor::kImu:
      usable.imu = false;
      return;
    case CheckedSensor::kWheels:
      usable.wheels = false;
      return;
    case CheckedSensor::kBarometer:
    case CheckedSensor::kBaseBarometer:
      usable.barometers = false;
      return;
    case CheckedSensor::kLidar:
      return;  // nothing works without it
  }
}

}  // namespace

UsableSensors usable_sensors(const Findings& findings) {
  UsableSensors usable;
  for (const Finding& finding : findings.all()) {
    leave_out(finding.sensor, usable);
    // A lidar in another direction or on another clock fits neither gravity nor the wheels; its scans alone make a map
    // that fits together.
    if (finding.sensor == CheckedSensor::kLidar) usable.imu = usable.wheels = false;
  }
  return usable;
}

}  // namespace isobar
