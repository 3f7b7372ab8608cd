// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/scan_pairs.hpp"

#include <cstdlib>

namespace isobar::iio {

void ScanPairs::clear() noexcept {
  gyro_.count = accel_.count = 0;
  clocks_differ_ = false;
}

bool ScanPairs::next(InertialScan& scan) noexcept {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  while (gyro_.count > 0 && accel_.count > 0) {
    const InertialScan& gyro = gyro_.at(0);
    while (accel_.count > 1 && accel_.at(1).time_ns <= gyro.time_ns) accel_.pop();
    const InertialScan& before = accel_.at(0);
    clocks_differ_ = std::abs(gyro.time_ns - before.time_ns) > kSecondNs;
    if (before.time_ns > gyro.time_ns) {  // begun later
      gyro_.pop();
      continue;
    }
    const bool equal = before.time_ns == gyro.time_ns;
    if (!equal && accel_.count == 1) return false;
    const InertialScan& after = equal ? before : accel_.at(1);
    const std::int64_t gap_ns = after.time_ns - before.time_ns;
    const double share =
        equal ? 0.0 : static_cast<double>(gyro.time_ns - before.time_ns) / static_cast<double>(gap_ns);
    scan = gyro;
    scan.accel_m_s2 = before.accel_m_s2 + share * (after.accel_m_s2 - before.accel_m_s2);
    gyro_.pop();
    if (gap_ns <= kLongestGapNs) return true;
  }
  return false;
}

}  // namespace isobar::iio
