// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar/lidar_counters.hpp"

namespace isobar {

void count_refused(DecodeStatus reason, LidarCounters& counters) {
  switch (reason) {
    case DecodeStatus::kNoPoints:
      ++counters.no_points;
      break;
    case DecodeStatus::kTruncated:
      ++counters.truncated;
      break;
    case DecodeStatus::kOversized:
      ++counters.oversized;
      break;
    case DecodeStatus::kWrongModel:
      ++counters.wrong_model;
      break;
    default:
      ++counters.garbage;
  }
}

}  // namespace isobar
