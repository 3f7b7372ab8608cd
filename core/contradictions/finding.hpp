// SPDX-License-Identifier: BSD-3-Clause
// What the data of the sensors say against the configuration or against each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/name_table.hpp"

namespace isobar {

/// A sensor of the robot, or the base station's barometer.
enum class CheckedSensor : std::uint8_t { kLidar, kImu, kBarometer, kBaseBarometer, kWheels };
inline constexpr std::size_t kCheckedSensors = 5;

inline constexpr NameTable<CheckedSensor, kCheckedSensors> kCheckedSensorNames{{{
    {CheckedSensor::kLidar, "lidar"},
    {CheckedSensor::kImu, "imu"},
    {CheckedSensor::kBarometer, "barometer"},
    {CheckedSensor::kBaseBarometer, "base_barometer"},
    {CheckedSensor::kWheels, "wheel"},
}}};

enum class Contradiction : std::uint8_t {
  kImuMount,           ///< gravity is not up; measured: angle from up [deg]; remedy: imu.rpy_deg
  kAccelUnit,          ///< measured: mean specific force; remedy[0]: factor to m/s^2
  kAccelNegated,       ///< gravity is down although the gyro turns as wheels or scans
  kGyroUnit,           ///< measured: gyro turn over reference turn; remedy[0]: factor to rad/s
  kGyroMirrored,       ///< measured: the same, about -1
  kLidarMirrored,      ///< the scans turn against gyro and wheels; measured: scans over wheels
  kLidarYaw,           ///< measured: direction of the scans against the wheels [deg]; remedy: lidar.rpy_deg
  kWheelsReversed,     ///< the wheels go backwards; measured: way of the scans over the wheels'
  kWheelsOrLidar,      ///< the one or the other: nothing tells which; remedy: lidar.rpy_deg
  kWheelUnit,          ///< measured: wheel speed over the scans'; remedy[0]: factor to m/s
  kWheelTurnReversed,  ///< measured: wheel turn over the scans', about -1
  kWheelTurnUnit,      ///< measured: the same; remedy[0]: factor to rad/s
  kBarometersSwapped,  ///< measured: pressure by which "base" moved while "robot" stood [Pa]
  kClocksApart,        ///< measured: clock of `sensor` minus clock of `other` [s]
  kNoOverlap,          ///< the same, and the streams have no time in common
};

/// Reference of a comparison.
enum class TurnReference : std::uint8_t { kScans, kWheels };

/// One contradiction. Trivially copyable.
struct Finding {
  Contradiction kind = Contradiction::kImuMount;
  CheckedSensor sensor = CheckedSensor::kImu;   ///< that is wrong, or most likely is
  CheckedSensor other = CheckedSensor::kLidar;  ///< against which it was compared
  double measured = 0.0;
  std::array<double, 3> remedy{};  ///< see Contradiction; else zero
  double confidence = 0.0;         ///< 0 … 1: correlation, or share of the windows that agree
  double evidence = 0.0;           ///< turn [rad], way [m] or time [s] that was compared
};

/// A few findings. Trivially copyable, allocates nothing; further ones than its capacity are dropped.
class Findings {
 public:
  static constexpr std::size_t kCapacity = 16;
  void add(const Finding& finding) {
    if (count_ < kCapacity) findings_[count_++] = finding;
  }
  [[nodiscard]] std::span<const Finding> all() const { return {findings_.data(), count_}; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// The first finding of a kind; null: none.
  [[nodiscard]] const Finding* find(Contradiction kind) const {
    for (const Finding& finding : all()) {
      if (finding.kind == kind) return &finding;
    }
    return nullptr;
  }

 private:
  std::array<Finding, kCapacity> findings_{};
  std::size_t count_ = 0;
};

/// Sensors that a run uses.
struct UsableSensors {
  bool imu = true;
  bool wheels = true;
  bool barometers = true;
  friend bool operator==(const UsableSensors&, const UsableSensors&) = default;
};

/// Sensors that are left when what the findings contradict is left out: a run without a sensor is a run that Isobar
/// knows (docs/missing-sensors.md), one with a wrong sensor is a wrong map.
UsableSensors usable_sensors(const Findings& findings);

}  // namespace isobar
