// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/pose_corrections.hpp"

#include <algorithm>

namespace isobar {
namespace {

// The live pose, moved with a key scan near it.
Eigen::Isometry3d moved_with(const CorrectedKey& key, const Eigen::Isometry3d& T_map_base) {
  return key.T_map_base_corrected * (key.T_map_base.inverse() * T_map_base);
}

}  // namespace

PoseCorrections::PoseCorrections(std::vector<CorrectedKey> keys, std::vector<std::int64_t> moved_ns)
    : keys_(std::move(keys)), moved_ns_(std::move(moved_ns)) {
  std::sort(keys_.begin(), keys_.end(),
            [](const CorrectedKey& a, const CorrectedKey& b) { return a.stamp_ns < b.stamp_ns; });
}

Eigen::Isometry3d PoseCorrections::corrected(std::int64_t stamp_ns,
                                             const Eigen::Isometry3d& T_map_base) const {
  if (keys_.empty()) return T_map_base;
  const auto after =
      std::upper_bound(keys_.begin(), keys_.end(), stamp_ns,
                       [](std::int64_t stamp, const CorrectedKey& key) { return stamp < key.stamp_ns; });
  if (after == keys_.begin()) return moved_with(keys_.front(), T_map_base);
  if (after == keys_.end()) return moved_with(keys_.back(), T_map_base);
  const auto before = std::prev(after);
  if (before->map_moves != after->map_moves) {
    const auto moved = std::upper_bound(moved_ns_.begin(), moved_ns_.end(), before->stamp_ns);
    const bool jumped = moved != moved_ns_.end() && stamp_ns >= *moved;
    return moved_with(jumped ? *after : *before, T_map_base);
  }
  const double share = static_cast<double>(stamp_ns - before->stamp_ns) /
                       static_cast<double>(after->stamp_ns - before->stamp_ns);
  const Eigen::Isometry3d by_first = moved_with(*before, T_map_base);
  const Eigen::Isometry3d by_second = moved_with(*after, T_map_base);
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.translation() = (1.0 - share) * by_first.translation() + share * by_second.translation();
  mean.linear() = Eigen::Quaterniond(by_first.linear())
                      .slerp(share, Eigen::Quaterniond(by_second.linear()))
                      .normalized()
                      .toRotationMatrix();
  return mean;
}

}  // namespace isobar
