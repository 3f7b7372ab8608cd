// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/calibration/height_difference.hpp"
#include "core/stamp.hpp"
#include "run/evaluation/trajectory.hpp"

namespace isobar::tools {

/// How far heights are from a reference once one constant has been taken off: where each of them counts from
/// is not theirs to know. Nothing else is fitted.
struct HeightErrors {
  std::size_t count = 0;
  double offset_m = 0.0;  ///< mean of height less reference: what was taken off
  double rms_m = 0.0;
  double largest_m = 0.0;
  double range_m = 0.0;  ///< of the reference where it was compared
};

/// At every height whose time lies between two poses at most half a second apart.
inline HeightErrors height_errors(const HeightSeries& series, const evaluation::Trajectory& reference) {
  constexpr double kMaxGapS = 0.5;
  std::vector<double> differences;
  double low_m = INFINITY;
  double high_m = -INFINITY;
  for (std::size_t i = 0; i < series.stamps_ns.size(); ++i) {
    const std::int64_t stamp_ns = series.stamps_ns[i];
    const auto after = std::upper_bound(
        reference.poses.begin(), reference.poses.end(), stamp_ns,
        [](std::int64_t stamp, const evaluation::StampedPose& pose) { return stamp < pose.stamp_ns; });
    if (after == reference.poses.begin() || after == reference.poses.end()) continue;
    const auto before = after - 1;
    const double gap_s = seconds_between(before->stamp_ns, after->stamp_ns);
    if (gap_s > kMaxGapS) continue;
    const double share = seconds_between(before->stamp_ns, stamp_ns) / gap_s;
    const double true_m = before->position_m.z() + share * (after->position_m.z() - before->position_m.z());
    differences.push_back(series.heights_m[i] - true_m);
    low_m = std::min(low_m, true_m);
    high_m = std::max(high_m, true_m);
  }
  HeightErrors errors;
  errors.count = differences.size();
  if (differences.empty()) return errors;
  for (const double difference : differences)
    errors.offset_m += difference / static_cast<double>(errors.count);
  for (const double difference : differences) {
    const double error_m = difference - errors.offset_m;
    errors.rms_m += error_m * error_m / static_cast<double>(errors.count);
    errors.largest_m = std::max(errors.largest_m, std::abs(error_m));
  }
  errors.rms_m = std::sqrt(errors.rms_m);
  errors.range_m = high_m - low_m;
  return errors;
}

}  // namespace isobar::tools
