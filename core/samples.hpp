// SPDX-License-Identifier: BSD-3-Clause
// Samples of the sensors. Trivially copyable values without pointers, as shared memory requires.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace isobar {

/// Standard gravity used everywhere in the estimator [m/s^2].
inline constexpr double kGravity = 9.80665;

/// Way on which a sample reached this machine.
enum class SamplePath : std::uint8_t {
  kLocal,     ///< a sensor of this machine, or a recording
  kDatagram,  ///< sample datagram (UDP)
  kDds,       ///< isobar-dds
};

/// How a live sample reached this machine; unknown in a recording. For the health report alone: estimates never use it.
struct SampleTiming {
  /// SampleTiming::clock_ahead_ns of a sensor without a clock of its own.
  static constexpr std::int64_t kNoClock = std::numeric_limits<std::int64_t>::min();

  std::int64_t received_ns = 0;            ///< arrival on this machine, robot clock; 0: unknown
  std::int64_t clock_ahead_ns = kNoClock;  ///< see ClockAnchor::device_ahead_ns()
};

/// One inertial sample, in the IMU's own frame. At rest and level accel reads (0, 0, +g).
struct ImuSample {
  std::int64_t stamp_ns = 0;                                        ///< time of the measurement, robot clock
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();             ///< angular rate
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();             ///< specific force
  Eigen::Quaterniond q_world_imu = Eigen::Quaterniond::Identity();  ///< attitude from the IMU's own filter
  bool has_attitude = false;                                        ///< q_world_imu is valid
  SamplePath path = SamplePath::kLocal;
  SampleTiming timing{};
};

/// One barometer sample, of the robot or of a base station.
struct PressureSample {
  std::int64_t stamp_ns = 0;   ///< time of the measurement, robot clock, also of a base station's sample
  double pressure_pa = 0.0;    ///< absolute pressure, compensated with the sensor's own coefficients
  double temperature_c = 0.0;  ///< temperature of the sensor, NaN if it has none
  /// White noise of this sample as stated by its sender [Pa^2], NaN if unknown.
  double variance_pa2 = std::numeric_limits<double>::quiet_NaN();
  std::uint8_t station = 0;  ///< base station: 0 the first, 1 the second
  SamplePath path = SamplePath::kLocal;
  SampleTiming timing{};
};

/// Wheel odometry: twist of base_link in base_link.
struct WheelSample {
  std::int64_t stamp_ns = 0;  ///< robot clock
  double vx_m_s = 0.0;
  double vy_m_s = 0.0;
  double wz_rad_s = 0.0;
  SamplePath path = SamplePath::kLocal;
  /// White noise of this sample as stated by its sender, NaN if unknown. What core believes of it: wheel_noise.hpp.
  double vx_variance_m2_s2 = std::numeric_limits<double>::quiet_NaN();
  double vy_variance_m2_s2 = std::numeric_limits<double>::quiet_NaN();
  double wz_variance_rad2_s2 = std::numeric_limits<double>::quiet_NaN();
  SampleTiming timing{};
};

/// One lidar return in the sensor's frame (x forward, y left, z up). No default initialisers: they would make
/// every loan of a chunk for 70 000 points write a megabyte of zeros.
struct ScanPoint {
  float x_m;
  float y_m;
  float z_m;
  std::uint16_t time_4us;  ///< firing time after Scan::stamp_ns, in units of 4 us (262 ms at most)
  std::uint8_t ring;       ///< laser, 0 is the lowest
  std::uint8_t intensity;  ///< calibrated reflectivity
};
static_assert(sizeof(ScanPoint) == 16 && std::is_trivially_default_constructible_v<ScanPoint>);

/// Unit of ScanPoint::time_4us [ns].
inline constexpr std::int64_t kPointTimeUnitNs = 4'000;

/// One revolution of the lidar. 1.1 MiB: a full revolution at 10 Hz of an HDL-32E or a dual-return VLP-16.
struct Scan {
  static constexpr std::uint32_t kMaxPoints = 70'000;

  std::int64_t stamp_ns = 0;       ///< time of the earliest possible point, robot clock
  std::int64_t end_stamp_ns = 0;   ///< time of the latest point, robot clock
  std::uint32_t sequence = 0;      ///< number of the scan in this run
  std::uint32_t point_count = 0;   ///< points[0 … point_count-1] are valid
  std::uint32_t packets_lost = 0;  ///< packets missing in this revolution, from gaps in time
  SampleTiming timing{};           ///< of a scan that was received whole, over DDS; else unknown
  ScanPoint points[kMaxPoints];    // NOLINT(modernize-avoid-c-arrays): payload in shared memory

  Scan() {}  // NOLINT: user-written: loaning a chunk must not zero a megabyte
};

}  // namespace isobar
