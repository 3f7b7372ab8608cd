// SPDX-License-Identifier: BSD-3-Clause
// One Gauss-Newton step, the same for every method: a basis of free directions, and the prior as a soft term.
#pragma once

#include <Eigen/Core>
#include <array>

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
  Eigen::Vector3d lever_sum = Eigen::Vector3d::Zero();         ///< weighted sum of p [m]
  Eigen::Matrix3d lever_square_sum = Eigen::Matrix3d::Zero();  ///< weighted sum of p p^T [m^2]
};

/// Prior term: deviation of the current estimate from the prediction, as a twist, and its information.
struct PriorTerm {
  Vector6d deviation = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();  ///< inverse covariance of the prediction, twist coordinates
};

/// Weights of the scan's information, and the noise that imitates it.
struct SolverWeights {
  double pair_information = 1.0;   ///< 1 / variance of one pair, correlation included [1/m^2]
  double normal_variance = 0.0;    ///< of a normal, either axis across it [rad^2]
  double point_variance_m2 = 0.0;  ///< of a point, each axis
  double correlated_pairs = 1.0;   ///< pairs with the information of one independent pair
};

/// A free direction and how well the scan holds it, see scan_information.hpp.
struct StepDirection {
  Vector6d axis = Vector6d::Zero();  ///< unit vector of twists, rotations times the points' mean distance
  double strength = 0.0;             ///< probability that the scan shows it, 0 ... 1
  double scan_information = 0.0;     ///< of the scan, in units of the prior's, per squared axis
};

struct Step {
  Vector6d twist = Vector6d::Zero();                               ///< step; zero outside the basis
  Matrix6d covariance = Matrix6d::Zero();                          ///< of the twist; zero outside the basis
  Eigen::Vector3d smallest_eigenvalues = Eigen::Vector3d::Zero();  ///< information per pair, ascending
  std::array<StepDirection, 6> directions;  ///< weakest first, as many as the basis has columns
  double lever_m = 1.0;                     ///< of the directions' rotations
  bool solved = false;  ///< false: singular (neither scan nor prior constrain a direction) or not finite
};

/// Minimises sum w e^2 * pair_information + deviation^T information deviation over the span of `basis`: with
/// B the basis, H and g the scan's weighted Hessian and gradient, L the prior's information and x its
/// deviation, (B^T (H + L) B) d = -B^T (g + L x). Equation (12) of the paper is the case of three columns and
/// no prior. Directions that the scan does not constrain follow the prior.
Step solve_step(const NormalEquations& equations, const PriorTerm& prior, const Basis& basis,
                const SolverWeights& weights);

}  // namespace isobar
