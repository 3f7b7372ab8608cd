// SPDX-License-Identifier: BSD-3-Clause
// Moves every point of a scan to where it would have been measured at the scan's end.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/estimates.hpp"
#include "core/prior/prior_history.hpp"

namespace isobar {

/// What moves the robot during the scan, beside the rotation, which is always the prior's.
struct ScanMotion {
  Prior end;                ///< prior at the scan's end
  bool from_wheels = true;  ///< translation from dead reckoning; else at constant velocity
  Eigen::Vector3d v_base_m_s =
      Eigen::Vector3d::Zero();  ///< that velocity, axes of base_link at the scan's end
};

/// Motion sampled at a fixed number of times, so that the cost a point is one matrix product.
class Deskewer {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link. Returns outside of min … max_range_m (from the sensor)
  /// are dropped, as are numbers that are not finite.
  Deskewer(const Eigen::Isometry3d& T_base_lidar, double min_range_m, double max_range_m);

  /// Takes in how the lidar moved during `scan`: what move() needs. Times that `history` does not reach use
  /// its nearest prior.
  void start(const Scan& scan, const PriorHistory& history, const ScanMotion& motion);
  /// Writes those of `points`, a part of that scan, which are in range, as p_base at scan.end_stamp_ns, to
  /// `out`; returns their number. `out` may be where `points` begin.
  std::size_t move(std::span<const ScanPoint> points, ScanPoint* out) const;

  /// Writes the points of `scan`, as p_base at scan.end_stamp_ns, to out.points and their number to
  /// out.point_count.
  void deskew(const Scan& scan, const PriorHistory& history, const ScanMotion& motion, RegisteredScan& out);

 private:
  // Columns of T_end_lidar, each padded to a register of four floats.
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
