// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_cell.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isobar {

namespace {
constexpr float kFewestPoints = 6.0F;
// A line with noise across it is as wide as it is thick; a plane is at least this much wider (variances).
constexpr double kLargestThicknessRatio = 0.15;
}  // namespace

void Moments::add(const Eigen::Vector3f& p_centre) {
  count += 1.0F;
  sum += p_centre;
  outer_diagonal += p_centre.cwiseProduct(p_centre);
  outer_off_diagonal +=
      Eigen::Vector3f(p_centre.x() * p_centre.y(), p_centre.x() * p_centre.z(), p_centre.y() * p_centre.z());
}

void Moments::add(const Moments& other, const Eigen::Vector3f& offset) {
  // sum (p + d)(p + d)^T = sum p p^T + s d^T + d s^T + n d d^T
  const Eigen::Vector3f& s = other.sum;
  const Eigen::Vector3f& d = offset;
  const float n = other.count;
  outer_diagonal += other.outer_diagonal + 2.0F * s.cwiseProduct(d) + n * d.cwiseProduct(d);
  outer_off_diagonal +=
      other.outer_off_diagonal + Eigen::Vector3f(s.x() * d.y() + s.y() * d.x() + n * d.x() * d.y(),
                                                 s.x() * d.z() + s.z() * d.x() + n * d.x() * d.z(),
                                                 s.y() * d.z() + s.z() * d.y() + n * d.y() * d.z());
  sum += s + n * d;
  count += n;
}

bool fit_plane(const Moments& moments, const PlaneCriteria& criteria, Plane& plane) {
  if (moments.count < kFewestPoints) {
    return false;
  }
  const double n = moments.count;
  const Eigen::Vector3d mean = moments.sum.cast<double>() / n;
  const Eigen::Vector3d diagonal = moments.outer_diagonal.cast<double>() / n - mean.cwiseProduct(mean);
  const Eigen::Vector3d off = moments.outer_off_diagonal.cast<double>() / n;
  Eigen::Matrix3d covariance = diagonal.asDiagonal();
  covariance(0, 1) = covariance(1, 0) = off.x() - mean.x() * mean.y();
  covariance(0, 2) = covariance(2, 0) = off.y() - mean.x() * mean.z();
  covariance(1, 2) = covariance(2, 1) = off.z() - mean.y() * mean.z();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const double thickness2 = std::max(solver.eigenvalues()(0), 1e-8);
  const double width2 = solver.eigenvalues()(1);
  if (!(thickness2 <= criteria.max_thickness_m * criteria.max_thickness_m) ||
      !(width2 >= criteria.min_width_m * criteria.min_width_m) ||
      !(thickness2 <= kLargestThicknessRatio * width2)) {
    return false;
  }
  const double deviation = std::sqrt(thickness2 / (width2 * n));
  if (deviation > criteria.max_normal_deviation_rad) {
    return false;
  }
  plane.mean = mean.cast<float>();
  plane.normal = solver.eigenvectors().col(0).cast<float>().normalized();
  plane.thickness_m = static_cast<float>(std::sqrt(thickness2));
  plane.normal_deviation_rad = static_cast<float>(deviation);
  return plane.normal.allFinite();
}

}  // namespace isobar
