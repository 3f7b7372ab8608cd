// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/deskew.hpp"

#include <algorithm>

#include "core/pose_carrying.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Two-level sampling of the motion. A prior every 2.048 ms, finer than an IMU's samples. Between them a knot
// every 256 us: its matrix is interpolated linearly (error below 1e-4 at 10 rad/s) and used for points at
// most 128 us away (0.13 mrad at 1 rad/s).
constexpr std::int64_t kUnitsPerKnot = 64;
constexpr std::int64_t kKnotsPerPrior = 8;
constexpr std::int64_t kPriorStepNs = kUnitsPerKnot * kKnotsPerPrior * kPointTimeUnitNs;
constexpr std::size_t kMaxKnots = (std::size_t{1} << 16U) / kUnitsPerKnot + kKnotsPerPrior + 1;

}  // namespace

Deskewer::Deskewer(const Eigen::Isometry3d& T_base_lidar, double min_range_m, double max_range_m)
    : T_base_lidar_(T_base_lidar),
      squared_min_range_m2_(static_cast<float>(min_range_m * min_range_m)),
      squared_max_range_m2_(static_cast<float>(max_range_m * max_range_m)),
      knots_(kMaxKnots) {}

Eigen::Isometry3d Deskewer::T_end_base(std::int64_t stamp_ns, const PriorHistory& history,
                                       const ScanMotion& motion) const {
  Prior prior = motion.end;
  if (!history.at(stamp_ns, prior) && !history.empty() && stamp_ns <= history.oldest().stamp_ns) {
    prior = history.oldest();
  }
  // PoseAnchor with base_link at the scan's end in place of the map frame.
  const PoseAnchor end(Eigen::Isometry3d::Identity(), motion.end.T_odom_base);
  Eigen::Isometry3d T = end.carried_to(prior.T_odom_base);
  if (!motion.turn_known) {
    T.linear() =
        exp_so3(motion.w_base_rad_s * seconds_between(motion.end.stamp_ns, stamp_ns)).toRotationMatrix();
  }
  if (!motion.from_wheels) {
    T.translation() = motion.v_base_m_s * seconds_between(motion.end.stamp_ns, stamp_ns);
  }
  return T;
}

void Deskewer::start(const Scan& scan, const PriorHistory& history, const ScanMotion& motion) {
  constexpr std::int64_t kLongestNs = std::int64_t{1 << 16} * kPointTimeUnitNs;
  const std::int64_t span_ns = std::clamp<std::int64_t>(scan.end_stamp_ns - scan.stamp_ns, 0, kLongestNs);
  const std::int64_t steps = span_ns / kPriorStepNs + 1;
  Eigen::Isometry3d T_before = T_end_base(scan.stamp_ns, history, motion) * T_base_lidar_;
  knot_count_ = 0;
  for (std::int64_t step = 0; step < steps; ++step) {
    const std::int64_t after_ns = scan.stamp_ns + (step + 1) * kPriorStepNs;
    const Eigen::Isometry3d T_after = T_end_base(after_ns, history, motion) * T_base_lidar_;
    for (std::int64_t k = 0; k < kKnotsPerPrior && knot_count_ < knots_.size(); ++k) {
      // Motion at the middle of the knot's 256 us.
      const double after = (static_cast<double>(k) + 0.5) / static_cast<double>(kKnotsPerPrior);
      Knot& knot = knots_[knot_count_++];
      const Eigen::Matrix4f T = (T_before.matrix() * (1.0 - after) + T_after.matrix() * after).cast<float>();
      knot = {T.col(0), T.col(1), T.col(2), T.col(3)};
    }
    T_before = T_after;
  }
}

std::size_t Deskewer::move(std::span<const ScanPoint> points, ScanPoint* out) const {
  std::size_t kept = 0;
  for (const ScanPoint& point : points) {
    const float squared_range = point.x_m * point.x_m + point.y_m * point.y_m + point.z_m * point.z_m;
    if (!(squared_range >= squared_min_range_m2_ && squared_range <= squared_max_range_m2_)) {
      continue;
    }
    const Knot& knot = knots_[std::min<std::size_t>(point.time_4us / kUnitsPerKnot, knot_count_ - 1)];
    const Eigen::Vector4f p_base = knot.x * point.x_m + knot.y * point.y_m + knot.z * point.z_m + knot.t;
    out[kept++] = {p_base.x(), p_base.y(), p_base.z(), point.time_4us, point.ring, point.intensity};
  }
  return kept;
}

}  // namespace isobar
