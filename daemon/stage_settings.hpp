// SPDX-License-Identifier: BSD-3-Clause
// Settings of the stages, from the configuration and, in a replay, from the recording.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "config/config.hpp"
#include "core/loops/loop_config.hpp"
#include "core/map/local_map.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/registration/registration.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/recording/manifest.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Settings of all stages.
struct StageSettings {
  LidarConfig lidar;
  std::string lidar_sender;   ///< see LidarSender
  bool imu_of_lidar = false;  ///< imu.source is lidar
  bool uses_wheels = true;    ///< wheel.source is not none
  PriorConfig prior;
  RegistrationConfig registration;
  MapConfig map;
  LoopConfig loops;
  Method method = Method::kAdaptive;
  Eigen::Isometry3d T_base_lidar = Eigen::Isometry3d::Identity();
};

/// Mount of the IMU: that of the lidar where it is the lidar's, since decoders give its samples in the lidar's frame.
[[nodiscard]] inline const Mount& imu_mount(const Config& config) {
  return config.imu.source == ImuSource::kLidar ? config.lidar.mount : config.imu.mount;
}

/// UDP port of the lidar's other packets; 0: its model has none, or the port of the data.
[[nodiscard]] std::uint16_t info_port_of(const LidarSettings& lidar);

/// Settings of a live run.
/// @throws ConfigError for a lidar model without a driver
StageSettings stage_settings(const Config& config);

/// Layout and limits of the map of a run on the disk.
MapHeader map_header(const Config& config);
TileStoreLimits map_limits(const Config& config);

/// `config` with its sensors and mounts replaced by those of a recording.
/// @throws DataError for a recording without lidar or IMU, or with a lidar model without a driver
Config with_sensors_of(const recording::Manifest& manifest, Config config);

/// Text of a run's settings.toml: every setting, and the version and commit that the run was made with.
std::string run_settings(const Config& config);

}  // namespace isobar
