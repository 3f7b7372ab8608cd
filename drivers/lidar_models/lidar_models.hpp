// SPDX-License-Identifier: BSD-3-Clause
// Registry of the lidar models: the one list that configuration, recordings, errors and documents read. A new
// model is a folder with its decoder, and a line in lidar_models.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/lidar/lidar_time.hpp"

namespace isobar {

/// What a decoder is made from.
struct LidarConfig {
  std::string model = "VLP-16";
  LidarLimits limits;
  /// The sensor's own calibration (RoboSense, Hesai: angles; Ouster: metadata); empty: nominal angles, where
  /// the model has them.
  std::string calibration_file;
  LidarTime time = LidarTime::kReceive;  ///< what stamps the points, for ScanAssembler
};

/// A model with a decoder.
struct LidarModel {
  std::string_view name;  ///< in configurations and recordings
  std::string_view maker;
  std::uint16_t port;       ///< UDP port of its data packets, factory setting
  std::uint16_t info_port;  ///< UDP port of its other packets: position, device information, IMU; 0: none
  bool has_imu;             ///< packets of its own IMU come on info_port
  bool needs_calibration;   ///< its packets cannot be decoded without LidarConfig::calibration_file
  std::unique_ptr<LidarDecoder> (*make)(const LidarConfig& config);
};

[[nodiscard]] std::span<const LidarModel> lidar_models();
/// The model of a name; nullptr for any other.
[[nodiscard]] const LidarModel* find_lidar_model(std::string_view name);
/// All names, in the order of the list.
[[nodiscard]] std::vector<std::string> lidar_model_names();
/// The names in one text, for messages: "VLP-16, HDL-32E and XT16".
[[nodiscard]] std::string lidar_model_list();

/// @throws ConfigError for an unknown model, a missing calibration file, or one that cannot be used
[[nodiscard]] std::unique_ptr<LidarDecoder> make_lidar_decoder(const LidarConfig& config);

}  // namespace isobar
