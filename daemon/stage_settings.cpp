// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/stage_settings.hpp"

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/map/grid.hpp"
#include "core/printable_text.hpp"
#include "core/version.hpp"

namespace isobar {

std::uint16_t info_port_of(const LidarSettings& lidar) {
  const LidarModel* model = find_lidar_model(lidar.model);
  const std::uint16_t port = lidar.info_port != 0 || model == nullptr ? lidar.info_port : model->info_port;
  return port == lidar.port ? 0 : port;
}

StageSettings stage_settings(const Config& config) {
  StageSettings settings;
  settings.lidar.model = config.lidar.model;
  settings.lidar.calibration_file = config.lidar.calibration_file;
  settings.lidar.time = config.lidar.time;
  settings.lidar_sender = config.lidar.sender;
  settings.lidar.limits.min_range_m = config.lidar.min_range_m;
  settings.lidar.limits.max_range_m = config.lidar.max_range_m;
  settings.lidar.limits.mask_start_deg = config.lidar.mask_start_deg;
  settings.lidar.limits.mask_end_deg = config.lidar.mask_end_deg;
  settings.uses_wheels = config.wheel.present();
  settings.prior = config.prior;
  settings.prior.has_imu = config.imu.present();
  settings.imu_of_lidar = config.imu.source == ImuSource::kLidar;
  settings.prior.T_base_imu = imu_mount(config).T_base_sensor();
  settings.prior.p_base_port = config.barometer.mount.xyz_m;
  settings.registration = config.registration;
  settings.registration.has_imu = config.imu.present();
  settings.map = config.map;
  settings.loops = config.loops;
  settings.method = config.method;
  settings.T_base_lidar = config.lidar.mount.T_base_sensor();
  return settings;
}

MapHeader map_header(const Config& config) {
  return {.tile_m = config.map.cell_m * kTileCells, .cell_m = config.map.cell_m};
}

TileStoreLimits map_limits(const Config& config) {
  return {.max_bytes = static_cast<std::uint64_t>(config.map_files.max_disk_gb * 1e9)};
}

Config with_sensors_of(const recording::Manifest& manifest, Config config) {
  if (!manifest.lidar) throw DataError("recording.toml: no [lidar]: there is nothing to register");
  const bool has_clouds = manifest.lidar->holds_clouds();
  if (!has_clouds && find_lidar_model(manifest.lidar->model) == nullptr) {
    throw DataError("recording.toml: lidar.model: \"" + printable(manifest.lidar->model) +
                    "\" has no driver; there are " + lidar_model_list());
  }
  config.lidar.source = has_clouds ? LidarSource::kDds : LidarSource::kDriver;
  // Of clouds no packet is decoded: any model does, best one that needs no calibration.
  config.lidar.model = has_clouds ? LidarSettings{}.model : manifest.lidar->model;
  if (has_clouds) config.lidar.calibration_file.clear();
  config.lidar.port = manifest.lidar->port;
  config.lidar.info_port = manifest.lidar->info_port;
  if (!manifest.lidar->calibration_file.empty()) {
    config.lidar.calibration_file = manifest.lidar->calibration_file;
  }
  if (config.lidar.sender.empty()) config.lidar.sender = manifest.lidar->sender;
  config.lidar.mount = manifest.lidar->mount;
  if (manifest.imu) {
    config.imu.mount = manifest.imu->mount;
  } else {
    const bool has_imu =
        !has_clouds && find_lidar_model(manifest.lidar->model)->has_imu && manifest.lidar->info_port != 0;
    config.imu.source = has_imu && config.imu.present() ? ImuSource::kLidar : ImuSource::kNone;
  }
  if (manifest.barometer) {
    config.barometer.mount = manifest.barometer->mount;
  } else {
    config.barometer.source = BarometerSource::kNone;
  }
  if (!manifest.wheel) config.wheel.source = WheelSource::kNone;
  return config;
}

std::string run_settings(const Config& config) {
  return "# Of a run of " + version_line("isobar") + "\n" + show_config(config);
}

}  // namespace isobar
