// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "run/recording/manifest.hpp"
#include "tools/import/request.hpp"

namespace isobar::tools {

/// Whether a file begins as a pcap or pcapng, compressed with gzip or not.
[[nodiscard]] bool is_capture(const std::filesystem::path& file);

/// Lidar of a capture.
struct CaptureFindings {
  recording::LidarEntry lidar;
  std::filesystem::path calibration;  ///< file to copy into the recording; empty: none
  std::int64_t first_ns = 0;          ///< first packet
  std::int64_t last_ns = 0;
};

/// Finds the port and the model of the lidar by the packets.
/// @param progress called with 0 … 1
/// @throws UsageError naming --lidar, --model or --calibration; DataError when the file holds no packets
[[nodiscard]] CaptureFindings find_lidar(const ImportRequest& request, ImportReport& report,
                                         const std::function<void(double)>& progress);

/// Puts the capture and the calibration into the folder.
/// @throws DataError when they cannot be written
void place_capture(const ImportRequest& request, const CaptureFindings& findings,
                   const std::filesystem::path& folder);

}  // namespace isobar::tools
