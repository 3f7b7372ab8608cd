// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/lidar/lidar_decoder.hpp"

namespace isobar {

/// Counters since construction; one writer.
struct LidarCounters {
  std::uint64_t packets = 0;    ///< data packets decoded
  std::uint64_t no_points = 0;  ///< packets of position, device information or IMU
  std::uint64_t truncated = 0;
  std::uint64_t oversized = 0;
  std::uint64_t garbage = 0;
  std::uint64_t wrong_model = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;    ///< decoded into the open scan
  std::uint64_t too_late = 0;     ///< reordered too late for the open scan, not decoded
  std::uint64_t lost = 0;         ///< missing packets, from gaps in the sensor's time
  std::uint64_t clock_steps = 0;  ///< steps of the sensor's or the host's clock
  std::uint64_t returns = 0;      ///< points written
  std::uint64_t scans = 0;        ///< scans completed
  std::uint64_t divided = 0;  ///< of these, full before their turn ended: more points than Scan::kMaxPoints
};

/// Counts a packet that is not decoded, by the reason.
void count_refused(DecodeStatus reason, LidarCounters& counters);

}  // namespace isobar
