// SPDX-License-Identifier: BSD-3-Clause
// One Gauss-Newton step, the same for every method: a basis of free directions, and the prior as a soft term.
#pragma once

#include <Eigen/Core>

#include "core/estimates.hpp"
#include "core/registration/method.hpp"

namespace isobar {

/// Weighted sums of J J^T and J e over the pairs; J = (p x n, n), see point_to_plane.hpp.
struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double weight_sum = 0.0;
  double squared_error_sum = 0.0;  ///< weighted [m^2]
  double squared_lever_sum = 0.0;  ///< weighted squared distance of the points from the robot [m^2]
};

/// Prior term: deviation of the current estimate from the prediction, as a twist, and its information.
struct PriorTerm {
  Vector6d deviation = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();  ///< inverse covariance of the prediction, twist coordinates
};

/// Weights of the scan's information.
struct SolverWeights {
  double pair_information = 1.0;        ///< 1 / variance of one pair, correlation included [1/m^2]
  double false_information = 0.0;       ///< spurious information per pair from errors of normals, 0 … 1
  double degenerate_information = 0.0;  ///< a direction with less information per pair is degenerate
};

struct Step {
  Vector6d twist = Vector6d::Zero();                               ///< step; zero outside the basis
  Matrix6d covariance = Matrix6d::Zero();                          ///< of the twist; zero outside the basis
  Eigen::Vector3d smallest_eigenvalues = Eigen::Vector3d::Zero();  ///< information per pair, ascending
  bool degenerate = false;
  bool solved = false;  ///< false: singular (neither scan nor prior constrain a direction) or not finite
};

/// Minimises sum w e^2 * pair_information + deviation^T information deviation over the span of `basis`: with
/// B the basis, H and g the scan's weighted Hessian and gradient, L the prior's information and x its
/// deviation, (B^T (H + L) B) d = -B^T (g + L x). Equation (12) of the paper is the case of three columns and
/// no prior. Directions that the scan does not constrain follow the prior.
Step solve_step(const NormalEquations& equations, const PriorTerm& prior, const Basis& basis,
                const SolverWeights& weights);

}  // namespace isobar
