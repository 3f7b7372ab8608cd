// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "drivers/lidar/angle_table.hpp"
#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/robosense/packet_format.hpp"

namespace isobar::robosense {

/// What a DIFOP packet tells.
struct DeviceInformation {
  AngleTable angles;  ///< as they stand there; broken_rule() tells whether they can be used
  bool dual = false;  ///< both returns of a firing
  LidarSync sync = LidarSync::kUnknown;
};

/// @param payload a DIFOP packet of kPacketBytes
[[nodiscard]] DeviceInformation read_device_information_of(const ModelTraits& traits,
                                                           std::span<const std::uint8_t> payload);

}  // namespace isobar::robosense
