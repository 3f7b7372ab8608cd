// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/key_scan.hpp"

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

void take_sample(const RegisteredScan& scan, std::size_t most, std::vector<Eigen::Vector3f>& sample) {
  sample.clear();
  const std::size_t stride = scan.point_count / most + 1;
  for (std::size_t i = 0; i < scan.point_count; i += stride) {
    sample.emplace_back(scan.points[i].x_m, scan.points[i].y_m, scan.points[i].z_m);
  }
}

bool KeyScanChoice::wants(const PoseEstimate& pose) const {
  if (pose.mode == PoseMode::kPriorOnly || !pose.for_map || place_unknown(pose)) return false;
  if (!pose.T_map_base.matrix().allFinite()) return false;
  if (!any_) return true;
  if (seconds_between(last_ns_, pose.stamp_ns) < kLeastS) return false;
  const Eigen::Isometry3d step = T_map_last_.inverse() * pose.T_map_base;
  return step.translation().norm() >= kDistanceM ||
         rotation_angle_rad(Eigen::Quaterniond(step.linear())) >= kAngleDeg * kRadPerDeg;
}

void KeyScanChoice::take(const PoseEstimate& pose) {
  if (any_) way_m_ += (pose.T_map_base.translation() - T_map_last_.translation()).norm();
  T_map_last_ = pose.T_map_base;
  last_ns_ = pose.stamp_ns;
  any_ = true;
}

}  // namespace isobar
