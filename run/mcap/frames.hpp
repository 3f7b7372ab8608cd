// SPDX-License-Identifier: BSD-3-Clause
// Names of frames in exported messages: the defaults of isobar-dds (ipc/dds_config.hpp; REP-105).
#pragma once

namespace isobar::mcap {

inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kBaseFrame = "base_link";
inline constexpr const char* kLidarFrame = "lidar";
inline constexpr const char* kImuFrame = "imu";
inline constexpr const char* kBarometerFrame = "barometer";
inline constexpr const char* kStationFrame = "base";  ///< of the base station

}  // namespace isobar::mcap
