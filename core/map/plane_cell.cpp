// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_cell.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace isobar {

namespace {
constexpr float kMinPoints = 6.0F;  // twice the three points that any plane would fit without residual
// Maximum ratio of the variances along the normal and along the narrower direction in the plane. It is 1 for
// a line with noise across it.
constexpr double kMaxVarianceRatio = 0.15;

// Invariants of a symmetric 3 x 3 matrix; its characteristic polynomial is
// x^3 - trace x^2 + minors x - determinant.
struct Invariants {
  double trace, minors, determinant;  // minors: sum of the three principal 2 x 2 minors
};

Invariants invariants_of(const Eigen::Matrix3d& A) {
  const double xx = A(1, 1) * A(2, 2) - A(1, 2) * A(1, 2);
  const double yy = A(0, 0) * A(2, 2) - A(0, 2) * A(0, 2);
  const double zz = A(0, 0) * A(1, 1) - A(0, 1) * A(0, 1);
  const double determinant = A(0, 0) * xx - A(0, 1) * (A(0, 1) * A(2, 2) - A(1, 2) * A(0, 2)) +
                             A(0, 2) * (A(0, 1) * A(1, 2) - A(1, 1) * A(0, 2));
  return {A.trace(), xx + yy + zz, determinant};
}

// Smallest eigenvalue of a positive semidefinite matrix by Newton's method from 0. The characteristic
// polynomial is concave below its first root, so that the iteration approaches it from the left and never
// overshoots. The eigenvalues of a plane are far apart: five steps reach 1e-12 at a ratio of 0.15, and most
// planes need three.
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

// Eigenvector of a simple eigenvalue x: it is perpendicular to the columns of A - x I, hence parallel to the
// cross product of any two. The longest of the three products has the smallest rounding error.
Eigen::Vector3d eigenvector_of(const Eigen::Matrix3d& A, double x) {
  const Eigen::Matrix3d M = A - x * Eigen::Matrix3d::Identity();
  Eigen::Vector3d longest = M.col(0).cross(M.col(1));
  for (const Eigen::Vector3d& other : {M.col(0).cross(M.col(2)).eval(), M.col(1).cross(M.col(2)).eval()}) {
    if (other.squaredNorm() > longest.squaredNorm()) longest = other;
  }
  return longest.normalized();
}
}  // namespace

bool fit_plane(const Moments& moments, const PlaneCriteria& criteria, Plane& plane) {
  if (moments.count < kMinPoints) {
    return false;
  }
  const double n = moments.count;
  const double share = 1.0 / n;  // one division instead of nine: this runs for many cells per scan
  const Eigen::Vector3d mean = moments.sum.cast<double>() * share;
  const Eigen::Vector3d diagonal = moments.outer_diagonal.cast<double>() * share - mean.cwiseProduct(mean);
  const Eigen::Vector3d off = moments.outer_off_diagonal.cast<double>() * share;
  Eigen::Matrix3d covariance = diagonal.asDiagonal();
  covariance(0, 1) = covariance(1, 0) = off.x() - mean.x() * mean.y();
  covariance(0, 2) = covariance(2, 0) = off.y() - mean.x() * mean.z();
  covariance(1, 2) = covariance(2, 1) = off.z() - mean.y() * mean.z();
  const Invariants invariants = invariants_of(covariance);
  const double min_width2 = criteria.min_width_m * criteria.min_width_m;
  // Early exit for points on a line: minors >= width2 * length2 and length2 >= trace / 3, so that a smaller
  // value of minors proves width2 < min_width2.
  if (!(invariants.minors >= min_width2 * invariants.trace / 3.0)) {
    return false;
  }
  const double smallest = smallest_eigenvalue(invariants);
  const double thickness2 = std::max(smallest, 1e-8);
  // The other two eigenvalues from their sum and product; width2 is the smaller one.
  const double half_sum = 0.5 * (invariants.trace - smallest);
  const double product = invariants.minors - smallest * 2.0 * half_sum;
  const double width2 = half_sum - std::sqrt(std::max(half_sum * half_sum - product, 0.0));
  if (!(thickness2 <= criteria.max_thickness_m * criteria.max_thickness_m) || !(width2 >= min_width2) ||
      !(thickness2 <= kMaxVarianceRatio * width2)) {
    return false;
  }
  const double deviation2 = thickness2 / (width2 * n);
  if (deviation2 > criteria.max_normal_deviation_rad * criteria.max_normal_deviation_rad) {
    return false;
  }
  plane.mean = mean.cast<float>();
  plane.normal = eigenvector_of(covariance, smallest).cast<float>();
  plane.thickness_m = static_cast<float>(std::sqrt(thickness2));
  return plane.normal.allFinite();
}

}  // namespace isobar
