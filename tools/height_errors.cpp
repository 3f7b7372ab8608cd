// SPDX-License-Identifier: BSD-3-Clause
#include "tools/height_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/stamp.hpp"

namespace isobar::tools {

namespace {

constexpr double kMaxGapS = 0.5;  // as in the evaluation: five scans at 10 Hz

/// Interpolated height of the reference; nullopt outside its time span and in gaps.
std::optional<double> reference_height_m(const evaluation::Trajectory& reference, std::int64_t stamp_ns) {
  const auto after = std::upper_bound(
      reference.poses.begin(), reference.poses.end(), stamp_ns,
      [](std::int64_t stamp, const evaluation::StampedPose& pose) { return stamp < pose.stamp_ns; });
  if (after == reference.poses.begin() || after == reference.poses.end()) return std::nullopt;
  const auto before = after - 1;
  const double gap_s = seconds_between(before->stamp_ns, after->stamp_ns);
  if (gap_s > kMaxGapS) return std::nullopt;
  const double share = seconds_between(before->stamp_ns, stamp_ns) / gap_s;
  return before->position_m.z() + share * (after->position_m.z() - before->position_m.z());
}

}  // namespace

HeightErrors height_errors(const HeightSeries& series, const evaluation::Trajectory& reference) {
  std::vector<double> differences_m;
  double low_m = INFINITY;
  double high_m = -INFINITY;
  for (std::size_t i = 0; i < series.stamps_ns.size(); ++i) {
    const std::optional<double> true_m = reference_height_m(reference, series.stamps_ns[i]);
    if (!true_m) continue;
    differences_m.push_back(series.heights_m[i] - *true_m);
    low_m = std::min(low_m, *true_m);
    high_m = std::max(high_m, *true_m);
  }
  HeightErrors errors;
  errors.count = differences_m.size();
  if (differences_m.empty()) return errors;
  const auto count = static_cast<double>(errors.count);
  for (const double difference_m : differences_m) errors.offset_m += difference_m / count;
  for (const double difference_m : differences_m) {
    const double error_m = difference_m - errors.offset_m;
    errors.rms_m += error_m * error_m / count;
    errors.largest_m = std::max(errors.largest_m, std::abs(error_m));
  }
  errors.rms_m = std::sqrt(errors.rms_m);
  errors.range_m = high_m - low_m;
  return errors;
}

}  // namespace isobar::tools
