// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/scan_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar {

namespace {

constexpr int kBinCount = static_cast<int>(ScanProfile::kBins);
// Points within 6 deg of level, squared tangent: walls, and no floor within 6 m of a lidar 0.6 m above it.
constexpr float kMostSlope2 = 0.011F;
constexpr float kLeastRangeM = 0.3F;
constexpr int kLeastPoints = 90;  // an eighth of a turn

int bin_of(float x_m, float y_m) {
  const float turns = std::atan2(y_m, x_m) / static_cast<float>(2.0 * kPi);
  const int bin = static_cast<int>(std::floor(turns * static_cast<float>(kBinCount)));
  return (bin % kBinCount + kBinCount) % kBinCount;
}

}  // namespace

ScanMotion::ScanMotion(const Eigen::Isometry3d& T_base_lidar)
    : R_base_lidar_(T_base_lidar.linear().cast<float>()), lever_m_(T_base_lidar.translation().head<2>()) {}

void ScanMotion::fill(const Scan& scan, ScanProfile& profile) const {
  profile = {};
  const std::uint32_t count = std::min(scan.point_count, Scan::kMaxPoints);
  for (std::uint32_t i = 0; i < count; ++i) {
    const ScanPoint& point = scan.points[i];
    const Eigen::Vector3f p = R_base_lidar_ * Eigen::Vector3f(point.x_m, point.y_m, point.z_m);
    const float range2 = p.head<2>().squaredNorm();
    if (!(range2 > kLeastRangeM * kLeastRangeM) || !(p.z() * p.z() < kMostSlope2 * range2)) continue;
    const float slope2 = p.z() * p.z() / range2;
    ScanProfile::Bin& bin = profile.bins[static_cast<std::size_t>(bin_of(p.x(), p.y()))];
    if (bin.valid && bin.slope2 <= slope2) continue;
    profile.points += bin.valid ? 0 : 1;
    bin.p_m = p.head<2>();
    bin.range_m = std::sqrt(range2);
    bin.slope2 = slope2;
    bin.valid = true;
  }
  fit_lines(profile);
}

std::optional<ScanStep> ScanMotion::add(const Scan& scan) {
  const std::int64_t middle_ns = scan.stamp_ns + (scan.end_stamp_ns - scan.stamp_ns) / 2;
  fill(scan, after_);
  const bool follows =
      started_ && middle_ns > before_ns_ && middle_ns - before_ns_ <= MotionSeries::kLongestGapNs;
  std::optional<ScanStep> step;
  if (follows && before_.points >= kLeastPoints && after_.points >= kLeastPoints) {
    step = match_profiles(before_, after_);
    step->from_ns = before_ns_;
    step->to_ns = middle_ns;
    // From the lidar to base_link: t_base = t + l - R l.
    const Eigen::Vector2d moved = lever_m_ - Eigen::Rotation2Dd(step->step.turn_rad) * lever_m_;
    step->step.x_m += moved.x();
    step->step.y_m += moved.y();
  }
  std::swap(before_, after_);
  before_ns_ = middle_ns;
  started_ = true;
  return step;
}

}  // namespace isobar
