// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/solver.hpp"

#include <Eigen/Cholesky>

#include "core/registration/scan_information.hpp"

namespace isobar {

Step solve_step(const NormalEquations& equations, const PriorTerm& prior, const Basis& basis,
                const SolverWeights& weights) {
  Step step;
  const ScanInformation scan = scan_information(equations, basis, weights);
  step.directions = scan.directions;
  step.lever_m = scan.lever_m;
  step.smallest_eigenvalues = scan.smallest_eigenvalues;
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
