// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_cell.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace isobar {

namespace {
constexpr float kFewestPoints = 6.0F;
// A line with noise across it is as wide as it is thick; a plane is at least this much wider (variances).
constexpr double kLargestThicknessRatio = 0.15;

// Invariants of a symmetric matrix A: its characteristic polynomial is x^3 - trace x^2 + minors x -
// determinant.
struct Invariants {
  double trace, minors, determinant;
};

Invariants invariants_of(const Eigen::Matrix3d& A) {
  const double xx = A(1, 1) * A(2, 2) - A(1, 2) * A(1, 2);
  const double yy = A(0, 0) * A(2, 2) - A(0, 2) * A(0, 2);
  const double zz = A(0, 0) * A(1, 1) - A(0, 1) * A(0, 1);
  const double determinant = A(0, 0) * xx - A(0, 1) * (A(0, 1) * A(2, 2) - A(1, 2) * A(0, 2)) +
                             A(0, 2) * (A(0, 1) * A(1, 2) - A(1, 1) * A(0, 2));
  return {A.trace(), xx + yy + zz, determinant};
}

// Smallest eigenvalue of a positive semidefinite matrix by Newton's method from 0: the polynomial is concave
// below its first root, so that it comes from the left and never overshoots. The roots of a plane lie far
// apart: five steps bring a ratio of 0.15 to 1e-12, and most need three.
double smallest_eigenvalue(const Invariants& of) {
  double x = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double value = ((x - of.trace) * x + of.minors) * x - of.determinant;
    const double slope = (3.0 * x - 2.0 * of.trace) * x + of.minors;
    if (!(slope > 0.0)) break;
    const double step = -value / slope;
    x = std::max(0.0, x + step);
    if (step <= 1e-9 * x) break;
  }
  return x;
}

// Eigenvector of a simple eigenvalue: what is perpendicular to the rows of A - x I. The longest of the three
// products is the one that rounding hurts least.
Eigen::Vector3d eigenvector_of(const Eigen::Matrix3d& A, double x) {
  const Eigen::Matrix3d M = A - x * Eigen::Matrix3d::Identity();
  Eigen::Vector3d longest = M.col(0).cross(M.col(1));
  for (const Eigen::Vector3d& other : {M.col(0).cross(M.col(2)).eval(), M.col(1).cross(M.col(2)).eval()}) {
    if (other.squaredNorm() > longest.squaredNorm()) longest = other;
  }
  return longest.normalized();
}
}  // namespace

void Moments::add(const Eigen::Vector3f& p_centre) {
  count += 1.0F;
  sum += p_centre;
  outer_diagonal += p_centre.cwiseProduct(p_centre);
  outer_off_diagonal +=
      Eigen::Vector3f(p_centre.x() * p_centre.y(), p_centre.x() * p_centre.z(), p_centre.y() * p_centre.z());
}

bool fit_plane(const Moments& moments, const PlaneCriteria& criteria, Plane& plane) {
  if (moments.count < kFewestPoints) {
    return false;
  }
  const double n = moments.count;
  const double share = 1.0 / n;  // divisions are slow, and all of this is once a cell and scan
  const Eigen::Vector3d mean = moments.sum.cast<double>() * share;
  const Eigen::Vector3d diagonal = moments.outer_diagonal.cast<double>() * share - mean.cwiseProduct(mean);
  const Eigen::Vector3d off = moments.outer_off_diagonal.cast<double>() * share;
  Eigen::Matrix3d covariance = diagonal.asDiagonal();
  covariance(0, 1) = covariance(1, 0) = off.x() - mean.x() * mean.y();
  covariance(0, 2) = covariance(2, 0) = off.y() - mean.x() * mean.z();
  covariance(1, 2) = covariance(2, 1) = off.z() - mean.y() * mean.z();
  const Invariants invariants = invariants_of(covariance);
  const double min_width2 = criteria.min_width_m * criteria.min_width_m;
  // What is no wider than a line needs no roots: minors >= width2 * length2, and length2 >= trace / 3.
  if (!(invariants.minors >= min_width2 * invariants.trace / 3.0)) {
    return false;
  }
  const double smallest = smallest_eigenvalue(invariants);
  const double thickness2 = std::max(smallest, 1e-8);
  // The other two by their sum and their product.
  const double half_sum = 0.5 * (invariants.trace - smallest);
  const double product = invariants.minors - smallest * 2.0 * half_sum;
  const double width2 = half_sum - std::sqrt(std::max(half_sum * half_sum - product, 0.0));
  if (!(thickness2 <= criteria.max_thickness_m * criteria.max_thickness_m) || !(width2 >= min_width2) ||
      !(thickness2 <= kLargestThicknessRatio * width2)) {
    return false;
  }
  const double deviation2 = thickness2 / (width2 * n);
  if (deviation2 > criteria.max_normal_deviation_rad * criteria.max_normal_deviation_rad) {
    return false;
  }
  plane.mean = mean.cast<float>();
  plane.normal = eigenvector_of(covariance, smallest).cast<float>();
  plane.thickness_m = static_cast<float>(std::sqrt(thickness2));
  plane.normal_deviation_rad = static_cast<float>(std::sqrt(deviation2));
  return plane.normal.allFinite();
}

}  // namespace isobar
