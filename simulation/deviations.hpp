// SPDX-License-Identifier: BSD-3-Clause
// Faults and deviations of a simulated run that the user asks for, besides the usual errors of its sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/time_course.hpp"

namespace isobar::simulation {

/// Deviations of one barometer.
struct BarometerDeviation {
  Ramp drift;                         ///< added to its pressure
  double thermometer_offset_k = 0.0;  ///< added to its temperature
};

/// Deviations of a run; the defaults are none. World, path and all other errors stay those of the seed.
struct Deviations {
  static constexpr double kFullBaseRateHz = 32.0;

  /// Standard deviation of roll, pitch and yaw of lidar and IMU against the manifest, each, in addition to the
  /// usual mounting errors [deg].
  double mount_error_deg = 0.0;
  BarometerDeviation robot;
  BarometerDeviation base;
  double base_rate_hz =
      kFullBaseRateHz;                  ///< samples that the base station sends, > 0, at most kFullBaseRateHz
  Ramp common_ramp;                     ///< of the air at both barometers
  Oscillation common_gust;              ///< of the air at both barometers
  std::optional<TimeSpan> base_silent;  ///< the base station sends nothing
  std::optional<double> airflow;  ///< share of the dynamic pressure of driving at the robot's port, signed
  std::optional<PressureRange> zones;   ///< offsets of ventilated zones
  std::optional<PressureRange> pulses;  ///< peaks of door pulses
  double start_at_s = 0.0;  ///< the recording leaves out the run before this time: it begins in motion
  bool without_imu = false;
  bool without_wheels = false;
  bool without_base = false;
  bool without_barometer = false;

  /// One entry a deviation as its command-line option, without dashes: "drift robot:0.5:60:70"; empty: none.
  [[nodiscard]] std::vector<std::string> options() const;
  /// options() for names of files: "-drift-robot-0.5-60-70"; empty: none.
  [[nodiscard]] std::string suffix() const;
};

}  // namespace isobar::simulation
