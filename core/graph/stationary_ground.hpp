// SPDX-License-Identifier: BSD-3-Clause
// Ground that does not move, as a factor of the pose graph: two submaps on the same floor have the same height.
//
//     e = (z_a - z_b) / sigma,   de/dz_a = 1 / sigma = -de/dz_b
#pragma once

#include "core/graph/graph_node.hpp"

namespace isobar {

/// Two nodes on the same ground.
struct StationaryGround {
  NodeId a = 0;
  NodeId b = 0;
  double sigma_m = 0.02;  ///< unevenness of the floor, 1 sigma
};

/// Error of the two heights over sigma.
inline double ground_error(const StationaryGround& factor, double z_a_m, double z_b_m) {
  return (z_a_m - z_b_m) / factor.sigma_m;
}

/// Jacobian of ground_error() by the step of `a`; that of `b` is its negative.
inline NodeJacobian<1> ground_jacobian(const StationaryGround& factor) {
  NodeJacobian<1> J = NodeJacobian<1>::Zero();
  J(2) = 1.0 / factor.sigma_m;
  return J;
}

}  // namespace isobar
