// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/ouster/packet_format.hpp"

namespace isobar::ouster {

/// Where the sensor's time comes from: setting timestamp_mode.
enum class TimestampMode : std::uint8_t { kUnknown, kInternal, kSyncPulse, kPtp };

/// Format of the packets of the sensor's IMU: setting udp_profile_imu.
enum class ImuProfile : std::uint8_t {
  kLegacy,            ///< one sample a packet, in g and deg/s
  kAccel32Gyro32Nmea  ///< several samples a packet, in m/s^2 and rad/s; firmware 3.2
};

/// What the packets do not tell of a sensor: its metadata (HTTP: /api/v1/sensor/metadata, or the file beside a
/// recording of Ouster's tools), of firmware 1.13 to 3.x.
struct Metadata {
  std::string file;                        ///< for messages
  std::string product_line;                ///< "OS-1-128"
  std::uint64_t serial = 0;                ///< 0: not told
  std::uint32_t init_id = 0;               ///< 0: not told
  const Profile* profile = &kProfiles[0];  ///< one of kProfiles
  bool has_safety_header = false;
  ImuProfile imu_profile = ImuProfile::kLegacy;
  TimestampMode timestamp_mode = TimestampMode::kUnknown;
  int pixels = 0;              ///< beams, rows of a column
  int columns_per_packet = 0;  ///< 1 … PacketColumns::kMost
  int columns_per_turn = 0;
  double turn_hz = 10.0;
  std::vector<double> altitude_deg;  ///< by row
  std::vector<double> azimuth_deg;   ///< by row, clockwise from above
  double beam_origin_x_mm = 0.0;     ///< of the beams' origin from the lidar's, towards the encoder position
  double beam_origin_z_mm = 0.0;
  Eigen::Matrix4d T_sensor_lidar = Eigen::Matrix4d::Identity();  // NOLINT: frames; lengths in mm
  Eigen::Matrix3d R_sensor_imu = Eigen::Matrix3d::Identity();    // NOLINT: frames
};

/// @param file for messages
/// @param model "OS0", "OS1" or "OS2": must be the sensor's
/// @throws ConfigError, text: "file: key: rule"
[[nodiscard]] Metadata parse_metadata(std::string_view json, const std::string& file, std::string_view model);
[[nodiscard]] Metadata read_metadata(const std::filesystem::path& file, std::string_view model);

}  // namespace isobar::ouster
