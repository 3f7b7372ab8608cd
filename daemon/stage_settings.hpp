// SPDX-License-Identifier: BSD-3-Clause
// From configuration (and recording) to what the stages need.
#pragma once

#include "config/config.hpp"
#include "daemon/lock_step.hpp"
#include "run/recording/manifest.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Settings of a live run. Throws ConfigError for a lidar model that has no driver.
StageSettings stage_settings(const Config& config);

/// How the map of a run lies on the disk.
MapHeader map_header(const Config& config);
TileStoreLimits map_limits(const Config& config);

/// `config` with the sensors and mounts of a recording in place of its own. Throws DataError for a recording
/// without lidar or IMU, or with a lidar that has no driver: nothing can be registered without them.
Config with_sensors_of(const recording::Manifest& manifest, Config config);

}  // namespace isobar
