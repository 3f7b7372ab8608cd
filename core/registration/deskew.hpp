// SPDX-License-Identifier: BSD-3-Clause
// Deskewing: motion compensation of a scan to the time of its end.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/estimates.hpp"
#include "core/prior/prior_history.hpp"

namespace isobar {

/// Motion of the robot during a scan: dead reckoning's, or where it knows none a constant twist.
struct ScanMotion {
  Prior end;                ///< prior at the scan's end
  bool from_wheels = true;  ///< true: translation from dead reckoning; false: from v_base_m_s
  bool turn_known = true;   ///< true: rotation from dead reckoning; false: from w_base_rad_s
  Eigen::Vector3d v_base_m_s =
      Eigen::Vector3d::Zero();  ///< constant velocity, axes of base_link at the scan's end
  Eigen::Vector3d w_base_rad_s = Eigen::Vector3d::Zero();  ///< constant angular rate, axes of base_link
};

/// Samples the motion at fixed steps of time, so that each point costs one matrix product. Allocates in its
/// constructor only. Not thread-safe.
class Deskewer {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link. Points outside of min … max_range_m (from the sensor)
  /// and points that are not finite are dropped.
  Deskewer(const Eigen::Isometry3d& T_base_lidar, double min_range_m, double max_range_m);

  /// Exchanges the mount, between two scans.
  void set_mount(const Eigen::Isometry3d& T_base_lidar) { T_base_lidar_ = T_base_lidar; }

  /// Samples the motion of the lidar during `scan`, for move(). Times before `history` use its oldest prior;
  /// times past its extrapolation, motion.end.
  void start(const Scan& scan, const PriorHistory& history, const ScanMotion& motion);
  /// Writes the points in range, moved to p_base at scan.end_stamp_ns, to `out` and returns their number.
  /// `points` are a part of the scan of start(). `out` holds as many points and may be `points.data()`.
  std::size_t move(std::span<const ScanPoint> points, ScanPoint* out) const;

 private:
  // Columns of T_end_lidar, each padded to four floats: one SSE register.
  struct Knot {
    Eigen::Vector4f x;
    Eigen::Vector4f y;
    Eigen::Vector4f z;
    Eigen::Vector4f t;
  };
  [[nodiscard]] Eigen::Isometry3d T_end_base(std::int64_t stamp_ns, const PriorHistory& history,
                                             const ScanMotion& motion) const;

  Eigen::Isometry3d T_base_lidar_;
  float squared_min_range_m2_;
  float squared_max_range_m2_;
  std::vector<Knot> knots_;
  std::size_t knot_count_ = 0;
};

}  // namespace isobar
