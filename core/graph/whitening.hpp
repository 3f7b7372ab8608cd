// SPDX-License-Identifier: BSD-3-Clause
// Whitening of a pose error: e^T covariance^-1 e = |W e|^2 with W = L^-1, covariance = L L^T.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/estimates.hpp"

namespace isobar {

/// Rows of a pose error that count between nodes held by gravity: x, y, z, yaw.
inline constexpr std::array<int, 4> kLevelRows{0, 1, 2, 5};

/// Whitening matrix of a covariance (x, y, z, roll, pitch, yaw). `level`: of x, y, z and yaw alone, whatever roll and pitch
/// are; the last two rows are then zero.
/// @return nothing where the covariance is not positive definite or not finite
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
  if (!inverse.allFinite()) return std::nullopt;
  if (!level) return inverse;
  Matrix6d W = Matrix6d::Zero();
  for (int j = 0; j < rows; ++j) {
    W.col(kLevelRows[static_cast<std::size_t>(j)]).head<4>() = inverse.col(j).head<4>();
  }
  return W;
}

}  // namespace isobar
