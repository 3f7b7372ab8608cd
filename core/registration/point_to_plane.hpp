// SPDX-License-Identifier: BSD-3-Clause
// Point-to-plane error, equation (8) of the paper: Jacobian, robust scale and normal equations.
//
//     e = n^T (exp(omega) p + r - d),   J = de/d(omega, r) at omega = r = 0 = (p x n, n),   p from the robot
//
// Rows 2, 3, 4 of J are a_k of equation (10), since n^T (omega_z x p) = omega_z . (p x n).
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/registration/correspondences.hpp"
#include "core/registration/solver.hpp"

namespace isobar {

/// Noise model of a residual.
struct PairNoise {
  /// Variance of the pose of a scan in the map that no solution removes, twist coordinates [rad^2, m^2]: of the fixed
  /// directions, and of the attitudes of the scans that laid the planes. Pairs that depend on it, by their lever or
  /// their normal, get a smaller weight.
  Eigen::Matrix<float, 6, 1> pose_variance = Eigen::Matrix<float, 6, 1>::Zero();
  /// 1 in the free directions, 0 in the fixed ones. The scale weights residuals by their normal's free part.
  Eigen::Matrix<float, 6, 1> free = Eigen::Matrix<float, 6, 1>::Ones();
  float noise_m = 0.02F;  ///< standard deviation of scan and map together; smallest scale of the loss
};

/// Robust standard deviation of the residuals [m]: 1.4826 times the weighted median of their absolute values
/// (MAD), noise_m … `largest_m`.
float residual_scale_m(std::span<const Pair> pairs, const PairNoise& noise, float largest_m);

/// Normal equations of all pairs with the weights of Geman and McClure, 1 / (1 + (e/c)^2)^2, c = 3 scale_m.
NormalEquations accumulate(std::span<const Pair> pairs, const PairNoise& noise, float scale_m);

}  // namespace isobar
