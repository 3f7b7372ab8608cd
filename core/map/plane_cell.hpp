// SPDX-License-Identifier: BSD-3-Clause
// Moments of the points of a cell and the plane through them.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// Number, sum and sum of outer products of points relative to a centre that the owner knows.
struct Moments {
  float count = 0.0F;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f outer_diagonal = Eigen::Vector3f::Zero();      ///< xx, yy, zz
  Eigen::Vector3f outer_off_diagonal = Eigen::Vector3f::Zero();  ///< xy, xz, yz

  void add(const Eigen::Vector3f& p_centre);
  [[nodiscard]] Eigen::Vector3f mean() const { return sum / count; }
};

/// What makes a cloud of points a plane.
struct PlaneCriteria {
  float max_thickness_m = 0.05F;           ///< standard deviation along the normal
  float max_normal_deviation_rad = 0.07F;  ///< of the normal's direction, from the points' spread
  float min_width_m = 0.035F;              ///< standard deviation along the narrower direction in the plane
};

/// Plane through a cloud of points.
struct Plane {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float thickness_m = 0.0F;
  float normal_deviation_rad = 0.0F;
};

/// Plane with the least squared distances. False where the points do not make one: too few, too thick, or on
/// a line, as the points of a single ring are. The sign of the normal is arbitrary.
bool fit_plane(const Moments& moments, const PlaneCriteria& criteria, Plane& plane);

}  // namespace isobar
