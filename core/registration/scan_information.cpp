// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/scan_information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/so3.hpp"

namespace isobar {

namespace {

// Lower bound of the lever: points at the robot's position would divide by zero.
constexpr double kShortestLeverM = 0.1;
// Share of each pair's information that is noise at least, for the inverse of N: rounding.
constexpr double kLeastNoise = 1e-12;
// Information over noise at which half of it is true.
constexpr double kHalfTrue = 2.0;

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Length that makes rotations comparable with translations: root mean square distance of the points.
double lever_m(const NormalEquations& equations) {
  return std::max(std::sqrt(equations.squared_lever_sum / equations.weight_sum), kShortestLeverM);
}

// Probability that more than half of a direction's information is true. `ratio`: information over that of noise.
double strength_of(double ratio, double independent_pairs) {
  const double variance = (2.0 + 4.0 * std::max(ratio - 1.0, 0.0)) / std::max(independent_pairs, 1.0);
  return normal_distribution((ratio - kHalfTrue) / std::sqrt(variance));
}

ScanInformation no_information(const Basis& basis) {
  const Eigen::Index k = basis.cols();
  ScanInformation none{MatrixK::Zero(k, k), VectorK::Zero(k), {}, 1.0, Eigen::Vector3d::Zero()};
  for (Eigen::Index i = 0; i < k; ++i) none.directions[static_cast<std::size_t>(i)].axis = basis.col(i);
  return none;
}

}  // namespace

Matrix6d noise_information(const NormalEquations& equations, const SolverWeights& weights) {
  const double sum = equations.weight_sum;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  Matrix6d spread;
  spread << equations.squared_lever_sum * I - equations.lever_square_sum, skew(equations.lever_sum),
      skew(equations.lever_sum).transpose(), sum * I;
  Matrix6d noise = weights.normal_variance * (spread - equations.hessian);
  noise.topLeftCorner<3, 3>() +=
      weights.point_variance_m2 * (sum * I - equations.hessian.bottomRightCorner<3, 3>());
  return noise;
}

ScanInformation scan_information(const NormalEquations& equations, const Basis& basis,
                                 const SolverWeights& weights) {
  if (!(equations.weight_sum > 0.0)) return no_information(basis);
  const Eigen::Index k = basis.cols();
  const double lever = lever_m(equations);
  // Basis scaled to metres at the lever's end.
  Vector6d unit = Vector6d::Ones();
  unit.head<3>().setConstant(1.0 / lever);
  const Basis scaled = unit.asDiagonal() * basis;
  const MatrixK H = scaled.transpose() * equations.hessian * scaled;
  MatrixK N = scaled.transpose() * noise_information(equations, weights) * scaled;
  N.diagonal().array() += kLeastNoise * equations.weight_sum;

  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixK> eigen(H, N);
  const Eigen::SelfAdjointEigenSolver<MatrixK> per_pair(H / equations.weight_sum, Eigen::EigenvaluesOnly);
  ScanInformation out = no_information(basis);
  out.lever_m = lever;
  if (eigen.info() != Eigen::Success) return out;
  const MatrixK& V = eigen.eigenvectors();  // V^T N V = I, so N V is the inverse of V^T
  VectorK kept(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const double ratio = std::max(eigen.eigenvalues()(i), 0.0);
    const double strength = strength_of(ratio, equations.weight_sum / weights.correlated_pairs);
    kept(i) = ratio > 1.0 ? strength * (1.0 - 1.0 / ratio) : 0.0;
    StepDirection& direction = out.directions[static_cast<std::size_t>(i)];
    direction.axis = (basis * V.col(i)).normalized();
    direction.strength = strength;
    direction.scan_information =
        weights.pair_information * kept(i) * ratio / V.col(i).squaredNorm();  // v^T H v of the unit vector
  }
  const MatrixK dual = N * V;
  // Back to the units of the basis: basis = unit^-1 scaled, hence d_scaled = (B^T unit^-1 B) d.
  const MatrixK to_scaled = basis.transpose() * unit.cwiseInverse().asDiagonal() * basis;
  const VectorK information = kept.cwiseProduct(eigen.eigenvalues());
  out.hessian = to_scaled.transpose() * (dual * information.asDiagonal() * dual.transpose()) * to_scaled;
  out.gradient = to_scaled.transpose() *
                 (dual * kept.cwiseProduct(V.transpose() * (scaled.transpose() * equations.gradient)));
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(3, k); ++i) {
    out.smallest_eigenvalues(i) = std::max(per_pair.eigenvalues()(i), 0.0);
  }
  return out;
}

}  // namespace isobar
