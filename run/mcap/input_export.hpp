// SPDX-License-Identifier: BSD-3-Clause
// The samples of a recording as ROS 2 messages in an MCAP file.
#pragma once

#include <filesystem>
#include <functional>

#include "run/mcap/mcap_writer.hpp"

namespace isobar::mcap {

/// Writes IMU, barometers, wheels and the sensors' mounts; the lidar's packets stay in the recording.
/// @throws DataError as recording::RecordingReader does
void export_inputs(const std::filesystem::path& recording, McapWriter& out,
                   const std::function<void(double)>& progress);

}  // namespace isobar::mcap
