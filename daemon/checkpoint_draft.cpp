// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/checkpoint_draft.hpp"

#include <algorithm>
#include <cmath>

#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

/// Longest step between two poses that gives a velocity.
constexpr double kMaxStepS = 0.5;
/// A larger velocity or rate is a correction, not a motion.
constexpr double kMaxSpeedMS = 15.0;
constexpr double kMaxRateRadS = 5.0;

struct Motion {
  Eigen::Vector3d v_map_m_s = Eigen::Vector3d::Zero();
  double yaw_rate_rad_s = 0.0;
};

Motion motion_between(const PoseEstimate& before, const PoseEstimate& pose) {
  Motion motion;
  const double step_s = seconds_between(before.stamp_ns, pose.stamp_ns);
  if (pose.session != before.session || step_s <= 0.0 || step_s >= kMaxStepS) return motion;
  motion.v_map_m_s = (pose.T_map_base.translation() - before.T_map_base.translation()) / step_s;
  const Eigen::Matrix3d R = pose.T_map_base.linear() * before.T_map_base.linear().transpose();
  motion.yaw_rate_rad_s = yaw_of(R) / step_s;
  if (motion.v_map_m_s.norm() > kMaxSpeedMS || std::abs(motion.yaw_rate_rad_s) > kMaxRateRadS) return {};
  return motion;
}

}  // namespace

void CheckpointDraft::note(const PoseEstimate& pose) noexcept {
  const Motion motion = motion_between(last_pose_, pose);
  last_pose_ = pose;
  if (pose.mode == PoseMode::kInitializing) return;
  checkpoint_.session = pose.session;
  checkpoint_.stamp_ns = pose.stamp_ns;
  checkpoint_.T_map_base = pose.T_map_base;
  checkpoint_.v_map_m_s = motion.v_map_m_s;
  checkpoint_.yaw_rate_rad_s = motion.yaw_rate_rad_s;
  if (pose.mode == PoseMode::kRegistered) {
    checkpoint_.overlap = std::clamp(pose.overlap, 0.0, 1.0);
    checkpoint_.residual_rms_m = std::clamp(pose.residual_rms_m, 0.0, 1.0);
  }
  due_ = true;
}

files::Checkpoint CheckpointDraft::at(std::int64_t now_ns, const HeightDatum& datum) const {
  files::Checkpoint checkpoint = checkpoint_;
  checkpoint.clock_ns = now_ns;
  checkpoint.datum = datum;
  for (std::size_t i = 0; i < HeightDatum::kStations; ++i) {
    if (datum.station_known[i]) checkpoint.stations[i] = stations_[i];
  }
  return checkpoint;
}

}  // namespace isobar
