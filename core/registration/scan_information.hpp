// SPDX-License-Identifier: BSD-3-Clause
// What a scan knows of the pose, without what noise pretends.
//
// J = (p x n, n) of a pair has errors of its normal and of its point, J + dJ. They put information into H = sum w J J^T
// that no surface has, also along a featureless corridor. Its expectation is known in closed form,
//
//     N = sum w E[dJ dJ^T] = s_n^2 (G - H) + s_p^2 (I sum w - sum w n n^T) in the block of rotations,
//     G = [ sum w (|p|^2 I - p p^T)   sum w [p]x ;  transposed   I sum w ]
//
// because dn is perpendicular to n. Directions v are those of H v = m N v: m is the information of a direction over that
// of noise alone, 1 where no surface shows the direction, and does not depend on units. From chi-squared distributed sums
// over n independent pairs, m has the variance (2 + 4 (m - 1)) / n.
#pragma once

#include <array>

#include "core/registration/solver.hpp"

namespace isobar {

using MatrixK = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using VectorK = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// Hessian and gradient in the coordinates of a basis, and its directions.
struct ScanInformation {
  MatrixK hessian;
  VectorK gradient;
  std::array<StepDirection, 6> directions;  ///< weakest first, as many as the basis has columns
  double lever_m = 1.0;
  Eigen::Vector3d smallest_eigenvalues = Eigen::Vector3d::Zero();  ///< information per pair, ascending
};

/// Noise is taken away, and a direction that is weak altogether: the prior holds it, and only it.
ScanInformation scan_information(const NormalEquations& equations, const Basis& basis,
                                 const SolverWeights& weights);

/// Expected information of noise alone, N above, in twist coordinates.
Matrix6d noise_information(const NormalEquations& equations, const SolverWeights& weights);

}  // namespace isobar
