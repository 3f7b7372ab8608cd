// SPDX-License-Identifier: BSD-3-Clause
// IMU packets: Ouster sensor documentation, "IMU Data Packet Format". Little-endian.
//
//   LEGACY, 48 bytes: diagnostic, accelerometer and gyroscope time (u64, ns), acceleration (3 f32, g), angular
//   rate (3 f32, deg/s)
//
//   ACCEL32_GYRO32_NMEA: packet header of 32 bytes, time and text of the last NMEA sentence (100 bytes), blocks
//   of 36 bytes, packet footer of 32 bytes. A block: timestamp (u64, ns), measurement id (u16), status (u16, bit
//   0: holds data), acceleration (3 f32, m/s^2), angular rate (3 f32, rad/s)
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "core/samples.hpp"
#include "drivers/ouster/metadata.hpp"

namespace isobar::ouster {

inline constexpr double kGravityM_S2 = 9.80665;  // NOLINT: the unit

/// Samples of the sensor's own IMU, in the axes of the sensor's frame, at the IMU's place.
class ImuReader {
 public:
  static constexpr std::size_t kMostSamples = 64;

  explicit ImuReader(const Metadata& metadata)
      : profile_(metadata.imu_profile), R_sensor_imu_(metadata.R_sensor_imu) {}

  /// Whether a payload is an IMU packet, by its size.
  [[nodiscard]] bool is_imu(std::span<const std::uint8_t> payload) const;
  /// Takes the samples of an IMU packet; values that are not finite are left out. The stamp of a LEGACY sample is
  /// the gyroscope's, on the clock of the lidar's columns.
  void read(std::span<const std::uint8_t> payload);
  /// Next sample of the last packet.
  bool take(ImuSample& sample);
  void clear() { count_ = next_ = 0; }

 private:
  void add(std::uint64_t stamp_ns, const std::uint8_t* values, double accel_unit, double gyro_unit);

  ImuProfile profile_;
  Eigen::Matrix3d R_sensor_imu_;
  std::array<ImuSample, kMostSamples> samples_{};
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace isobar::ouster
