// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/pose_hint.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isobar::ipc {
namespace {

/// Beyond these no robot is [m], and no variance says anything [m^2, rad^2].
constexpr double kFarthestM = 1e6;
constexpr double kLargestVariance = 1e12;
/// Rounding errors of a covariance, relative to its largest variance.
constexpr double kRounding = 1e-6;

bool is_covariance(const std::array<double, 36>& values) {
  using Matrix = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> C(values.data());
  const double largest = C.diagonal().cwiseAbs().maxCoeff();
  if (!C.allFinite() || largest > kLargestVariance) return false;
  const double tolerance = kRounding * largest;
  if ((C - C.transpose()).cwiseAbs().maxCoeff() > tolerance) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(C, Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success && solver.eigenvalues().minCoeff() >= -tolerance;
}

}  // namespace

const char* implausibility(const PoseHint& hint) noexcept {
  const auto is_near = [](double m) { return std::isfinite(m) && std::abs(m) <= kFarthestM; };
  if (!is_near(hint.x_m) || !is_near(hint.y_m) || (hint.has_z && !is_near(hint.z_m))) {
    return "the position must be finite and within 1000 km";
  }
  if (!std::isfinite(hint.yaw_rad) || std::abs(hint.yaw_rad) > 100.0) return "the yaw must be an angle";
  if (!is_covariance(hint.covariance)) {
    return "the covariance must be finite, symmetric and positive semi-definite";
  }
  return nullptr;
}

}  // namespace isobar::ipc
