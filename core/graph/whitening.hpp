// SPDX-License-Identifier: BSD-3-Clause
// Whitening of a pose error: e^T covariance^-1 e = |W e|^2 with W = L^-1, covariance = L L^T.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/estimates.hpp"

namespace isobar {

/// Least standard deviation of a measurement [m, rad]: a smaller one is a fault, and rounding would ruin the others.
inline constexpr double kLeastSigma = 1e-7;

/// Rows of a pose error that count between nodes held by gravity: x, y, z, yaw.
inline constexpr std::array<int, 4> kLevelRows{0, 1, 2, 5};

/// Whitening matrix of a covariance (x, y, z, roll, pitch, yaw). `level`: of x, y, z and yaw alone, whatever roll and pitch
/// are; the last two rows are then zero.
/// @return nothing where the covariance is not positive definite, not finite, or below kLeastSigma in a direction
inline std::optional<Matrix6d> whitening(const Matrix6d& covariance, bool level) {
  const int rows = level ? 4 : 6;
  Matrix6d used = Matrix6d::Identity();
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < rows; ++j) {
      const auto at = [&](int row) { return level ? kLevelRows[static_cast<std::size_t>(row)] : row; };
      used(i, j) = 0.5 * (covariance(at(i), at(j)) + covariance(at(j), at(i)));
    }
  }
  const Eigen::LLT<Matrix6d> factor(used);
  if (!used.allFinite() || factor.info() != Eigen::Success) return std::nullopt;
  const Matrix6d inverse = factor.matrixL().solve(Matrix6d::Identity());
  const double largest = inverse.cwiseAbs().maxCoeff();
  if (!(largest <= 1.01 / kLeastSigma)) return std::nullopt;  // also where it is not a number
  if (!level) return inverse;
  Matrix6d W = Matrix6d::Zero();
  for (int j = 0; j < rows; ++j) {
    W.col(kLevelRows[static_cast<std::size_t>(j)]).head<4>() = inverse.col(j).head<4>();
  }
  return W;
}

}  // namespace isobar
