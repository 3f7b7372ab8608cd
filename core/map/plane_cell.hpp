// SPDX-License-Identifier: BSD-3-Clause
// Least-squares plane through the points of a cell, from their moments.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// Zeroth, first and second moments of points about a reference point that the owner defines.
struct Moments {
  float count = 0.0F;                                            ///< number of points
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();                 ///< [m]
  Eigen::Vector3f outer_diagonal = Eigen::Vector3f::Zero();      ///< sums of xx, yy, zz [m^2]
  Eigen::Vector3f outer_off_diagonal = Eigen::Vector3f::Zero();  ///< sums of xy, xz, yz [m^2]
};

/// Conditions under which points count as a plane.
struct PlaneCriteria {
  float max_thickness_m = 0.05F;           ///< standard deviation of the points along the normal
  float max_normal_deviation_rad = 0.07F;  ///< standard deviation of the normal, thickness / (width sqrt(n))
  float min_width_m = 0.035F;              ///< standard deviation along the narrower direction in the plane
};

/// Plane through points.
struct Plane {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();    ///< mean of the points, from their reference point [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit normal of arbitrary sign
  float thickness_m = 0.0F;                          ///< standard deviation of the points along the normal
};

/// Least-squares plane: its normal is the eigenvector of the smallest eigenvalue of the points' covariance.
/// Returns false if the points are no plane: too few, too thick, or on a line as those of a single lidar
/// ring.
bool fit_plane(const Moments& moments, const PlaneCriteria& criteria, Plane& plane);

}  // namespace isobar
