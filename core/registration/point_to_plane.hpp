// SPDX-License-Identifier: BSD-3-Clause
// The point-to-plane error, equation (8) of the paper, its Jacobian and its robust sum.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/registration/correspondences.hpp"
#include "core/registration/solver.hpp"

namespace isobar {

/// Jacobian of e = n^T (exp(omega) p + r - d) at omega = r = 0, with p from the robot: (p x n, n). Its rows
/// 2, 3, 4 are a_k of equation (10), since n^T (omega_z x p) = omega_z . (p x n).
inline Eigen::Matrix<float, 6, 1> point_to_plane_jacobian(const Pair& pair) {
  Eigen::Matrix<float, 6, 1> jacobian;
  jacobian << pair.p_robot.cross(pair.normal), pair.normal;
  return jacobian;
}

/// How sure a residual is apart from the scan's and the map's noise.
struct PairNoise {
  /// Variance of the directions that the solver may not move: pairs that feel an error of height or of
  /// gravity's attitude count less. Twist coordinates; zero in the free directions.
  Eigen::Matrix<float, 6, 1> fixed_variance = Eigen::Matrix<float, 6, 1>::Zero();
  /// One where the solver is free to move, else zero. Residuals count by their translation's share of it.
  Eigen::Matrix<float, 6, 1> free = Eigen::Matrix<float, 6, 1>::Ones();
  float noise_m = 0.02F;  ///< of scan and map, smallest scale of the loss
};

/// Robust standard deviation of the residuals: 1.4826 times their weighted median, at least noise_m and at
/// most `largest_m`.
float residual_scale_m(std::span<const Pair> pairs, const PairNoise& noise, float largest_m);

/// Sums the pairs with Geman and McClure's weights 1 / (1 + (e/c)^2)^2, c three times the scale.
NormalEquations accumulate(std::span<const Pair> pairs, const PairNoise& noise, float scale_m);

}  // namespace isobar
