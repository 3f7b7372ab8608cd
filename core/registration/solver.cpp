// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isobar {

namespace {

using MatrixK = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using VectorK = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

// Lower bound of the lever: points at the robot's position would divide by zero.
constexpr double kShortestLeverM = 0.1;

// Length that makes rotations comparable with translations: root mean square distance of the points.
double lever_m(const NormalEquations& equations) {
  return std::max(std::sqrt(equations.squared_lever_sum / equations.weight_sum), kShortestLeverM);
}

struct Information {
  MatrixK hessian;
  VectorK gradient;
};

// Information of the scan in the free directions, minus the spurious part from errors of the normals.
Information true_information(const NormalEquations& equations, const Basis& basis,
                             const SolverWeights& weights, Step& step) {
  const Eigen::Index k = basis.cols();
  Information information{MatrixK::Zero(k, k), VectorK::Zero(k)};
  if (!(equations.weight_sum > 0.0)) {
    step.degenerate = true;
    return information;
  }
  Vector6d unit = Vector6d::Ones();
  unit.head<3>().setConstant(1.0 / lever_m(equations));
  // Basis scaled to metres at the lever's end.
  const Basis scaled = unit.asDiagonal() * basis;
  const MatrixK per_pair = scaled.transpose() * equations.hessian * scaled / equations.weight_sum;
  const VectorK gradient = scaled.transpose() * equations.gradient;
  const Eigen::SelfAdjointEigenSolver<MatrixK> eigen(per_pair);
  VectorK kept(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const double value = std::max(eigen.eigenvalues()(i), 0.0);
    kept(i) = value > weights.false_information ? 1.0 - weights.false_information / value : 0.0;
  }
  const MatrixK& V = eigen.eigenvectors();
  const MatrixK hessian =
      V * (eigen.eigenvalues().cwiseProduct(kept) * equations.weight_sum).asDiagonal() * V.transpose();
  // Back to the units of the basis: basis = unit^-1 scaled, hence d_scaled = (B^T unit^-1 B) d.
  const MatrixK to_scaled = basis.transpose() * unit.cwiseInverse().asDiagonal() * basis;
  information.hessian = to_scaled.transpose() * hessian * to_scaled;
  information.gradient = to_scaled.transpose() * (V * kept.asDiagonal() * V.transpose() * gradient);
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(3, k); ++i) {
    step.smallest_eigenvalues(i) = std::max(eigen.eigenvalues()(i), 0.0);
  }
  step.degenerate = step.smallest_eigenvalues(0) < weights.degenerate_information;
  return information;
}

}  // namespace

Step solve_step(const NormalEquations& equations, const PriorTerm& prior, const Basis& basis,
                const SolverWeights& weights) {
  Step step;
  const Information scan = true_information(equations, basis, weights, step);
  const MatrixK hessian =
      weights.pair_information * scan.hessian + basis.transpose() * prior.information * basis;
  const VectorK gradient =
      weights.pair_information * scan.gradient + basis.transpose() * (prior.information * prior.deviation);
  const Eigen::LDLT<MatrixK> factors(hessian);
  if (factors.info() != Eigen::Success || !factors.isPositive() ||
      !(factors.vectorD().minCoeff() > 1e-12 * factors.vectorD().maxCoeff())) {
    return step;
  }
  const Eigen::Index k = basis.cols();
  step.twist = -(basis * factors.solve(gradient));
  step.covariance = basis * factors.solve(MatrixK::Identity(k, k)) * basis.transpose();
  step.solved = step.twist.allFinite() && step.covariance.allFinite();
  return step;
}

}  // namespace isobar
