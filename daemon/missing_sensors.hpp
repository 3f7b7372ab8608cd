// SPDX-License-Identifier: BSD-3-Clause
// What a run does without a sensor, and what that costs: one sentence a sensor, for log and replay.
#pragma once

#include <string>
#include <vector>

#include "config/config.hpp"

namespace isobar {

/// Sensors that a run has.
struct PresentSensors {
  bool imu = true;
  bool wheels = true;
  bool barometer = true;
  bool base_station = true;
};

/// Those that a live run is configured for.
[[nodiscard]] PresentSensors present_sensors(const Config& config);

/// A sentence for each sensor that is missing, of a method whose inputs it is; docs/missing-sensors.md has the figures.
[[nodiscard]] std::vector<std::string> missing_sensor_texts(const PresentSensors& present);

}  // namespace isobar
