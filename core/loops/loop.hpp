// SPDX-License-Identifier: BSD-3-Clause
// A loop: a key scan that was matched to a submap of an earlier visit.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

/// Match of a key scan of one submap to another submap.
struct Loop {
  std::size_t submap = 0;  ///< submap of the earlier visit
  std::size_t holder = 0;  ///< submap that holds the key scan
  std::int64_t stamp_ns = 0;
  double way_m = 0.0;                                               ///< of the key scan
  Eigen::Isometry3d T_submap_base = Eigen::Isometry3d::Identity();  ///< of the key scan, as matched
  Eigen::Isometry3d T_holder_base =
      Eigen::Isometry3d::Identity();       ///< of the key scan, as its own submap has it
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_submap_base: x, y, z, roll, pitch, yaw, axes of `submap`
  double overlap = 0.0;
  double residual_rms_m = 0.0;

  /// Pose of the holder in the submap.
  [[nodiscard]] Eigen::Isometry3d T_submap_holder() const { return T_submap_base * T_holder_base.inverse(); }
  /// Covariance of T_submap_holder(), in the same order and axes.
  [[nodiscard]] Matrix6d holder_covariance() const;
};

}  // namespace isobar
