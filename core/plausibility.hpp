// SPDX-License-Identifier: BSD-3-Clause
// Plausible ranges of sample values, for every robot: a value outside is a fault of the sensor or of the
// transport. Files, datagrams, DDS and device drivers share them, so that live runs and replays refuse the
// same samples. Narrower limits have other names: the operating range of a sensor (DPS310), the range of a
// robot's IMU (PriorLimits), the top speed of its wheels (DeadReckoningConfig), the pressures at its site
// (AltimeterConfig).
#pragma once

#include <cmath>
#include <cstdint>

#include "core/samples.hpp"

namespace isobar {

struct PlausibleRange {
  double lowest;
  double highest;
  /// False for NaN and infinities.
  [[nodiscard]] constexpr bool holds(double value) const { return value >= lowest && value <= highest; }
};

/// Absolute pressure [Pa]: 10 kPa is 16 km above the sea, 120 kPa is 1.4 km below it; barometers for robots
/// measure 30 … 120 kPa. The deepest mines, 4 km, are outside.
inline constexpr PlausibleRange kPlausiblePressurePa{10e3, 120e3};
/// Air pressure where robots drive [Pa]: from 9 km above the sea to a mine 1.1 km below it. Narrower than
/// kPlausiblePressurePa: default of the altimeter's limits, and narrow enough to tell Pa, hPa and kPa apart.
inline constexpr PlausibleRange kGroundPressurePa{30e3, 115e3};
/// Temperature of a sensor [degrees Celsius]: from a polar night to the limit of automotive silicon.
inline constexpr PlausibleRange kPlausibleTemperatureC{-60.0, 100.0};
/// Angular rate, each axis [rad/s]: MEMS gyros of robots saturate at 2000 deg/s = 34.9 rad/s.
inline constexpr PlausibleRange kPlausibleGyroRadS{-40.0, 40.0};
/// Specific force, each axis [m/s^2]: MEMS accelerometers of robots saturate at 16 … 40 g.
inline constexpr PlausibleRange kPlausibleAccelMS2{-400.0, 400.0};
/// Speed from wheels, each axis [m/s]: 72 km/h, twice the default of DeadReckoningConfig.
inline constexpr PlausibleRange kPlausibleWheelMS{-20.0, 20.0};
/// Yaw rate from wheels [rad/s]: no faster than the gyro can follow.
inline constexpr PlausibleRange kPlausibleWheelRadS{-40.0, 40.0};
/// Norm of an attitude quaternion that was printed with few decimals; readers normalise it.
inline constexpr PlausibleRange kPlausibleQuaternionNorm{0.9, 1.1};
/// Stamps [ns since 1970]: 1970 to 2100. int64 overflows in 2262; adding a clock offset to a stamp must not.
inline constexpr std::int64_t kPlausibleStampLowestNs = 0;
inline constexpr std::int64_t kPlausibleStampHighestNs = 4'102'444'800LL * 1'000'000'000LL;

/// The rule that a sample breaks, a static text; nullptr when the sample is plausible.
[[nodiscard]] inline const char* implausibility(const ImuSample& sample) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!kPlausibleGyroRadS.holds(sample.gyro_rad_s[axis])) {
      return "angular rate must lie within -40 … 40 rad/s";
    }
    if (!kPlausibleAccelMS2.holds(sample.accel_m_s2[axis])) {
      return "specific force must lie within -400 … 400 m/s^2";
    }
  }
  if (sample.has_attitude && !kPlausibleQuaternionNorm.holds(sample.q_world_imu.norm())) {
    return "attitude quaternion must have norm 1";
  }
  return nullptr;
}

/// As above. A NaN temperature is plausible: the sensor has no thermometer.
[[nodiscard]] inline const char* implausibility(const PressureSample& sample) {
  if (!kPlausiblePressurePa.holds(sample.pressure_pa)) {
    return "pressure must lie within 10000 … 120000 Pa";
  }
  if (!std::isnan(sample.temperature_c) && !kPlausibleTemperatureC.holds(sample.temperature_c)) {
    return "temperature must lie within -60 … 100 degrees C";
  }
  return nullptr;
}

[[nodiscard]] inline const char* implausibility(const WheelSample& sample) {
  if (!kPlausibleWheelMS.holds(sample.vx_m_s) || !kPlausibleWheelMS.holds(sample.vy_m_s)) {
    return "wheel speed must lie within -20 … 20 m/s";
  }
  if (!kPlausibleWheelRadS.holds(sample.wz_rad_s)) {
    return "wheel yaw rate must lie within -40 … 40 rad/s";
  }
  return nullptr;
}

[[nodiscard]] inline const char* implausible_stamp(std::int64_t stamp_ns) {
  const bool plausible = stamp_ns >= kPlausibleStampLowestNs && stamp_ns <= kPlausibleStampHighestNs;
  return plausible ? nullptr : "stamp must lie between the years 1970 and 2100";
}

}  // namespace isobar
