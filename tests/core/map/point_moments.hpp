// SPDX-License-Identifier: BSD-3-Clause
// Moments of points in floating point: the reference for the fixed-point moments of a cell.
#pragma once

#include <Eigen/Core>

#include "core/map/plane_cell.hpp"

namespace isobar::test {

/// Adds a point, from the reference point of the moments [m].
inline void add_point(Moments& moments, const Eigen::Vector3f& p) {
  moments.count += 1.0F;
  moments.sum += p;
  moments.outer_diagonal += p.cwiseProduct(p);
  moments.outer_off_diagonal += Eigen::Vector3f(p.x() * p.y(), p.x() * p.z(), p.y() * p.z());
}

inline Eigen::Vector3f mean_of(const Moments& moments) { return moments.sum / moments.count; }

}  // namespace isobar::test
