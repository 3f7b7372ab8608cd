// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/lidar_models/lidar_models.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar {

/// The clock in a lidar's data packets, for the reader of a recording. Has a decoder of its own.
/// @throws ConfigError as make_lidar_decoder()
[[nodiscard]] recording::LidarClock lidar_clock(const LidarConfig& lidar);

}  // namespace isobar
