// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/geometry.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_so3 {

namespace {

// exp([w]x) = I + [w]x + [w]x^2 / 2! + …
Eigen::Matrix3d exponential_series(const Eigen::Vector3d& w) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  for (int n = 1; n <= 40; ++n) {
    term = term * skew(w) / n;
    sum += term;
  }
  return sum;
}

// Rotation vectors of all lengths up to pi, the first-order branch included.
std::vector<Eigen::Vector3d> rotation_vectors() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<Eigen::Vector3d> all{Eigen::Vector3d::Zero()};
  for (const double length : {1e-12, 0.99e-9, 1.01e-9, 2.01e-9, 1e-6, 1e-3, 0.1, 1.0, 3.0, 3.14159}) {
    for (int i = 0; i < 5; ++i) {
      all.push_back(length * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());
    }
  }
  return all;
}

}  // namespace

TEST_CASE("the exponential map is the matrix exponential's series and Eigen's angle-axis rotation") {
  for (const Eigen::Vector3d& w : rotation_vectors()) {
    const Eigen::Matrix3d R = exp_so3(w).toRotationMatrix();
    CHECK((R - exponential_series(w)).norm() < 1e-13);  // rounding of forty terms up to pi^n / n!
    const Eigen::Vector3d axis = w.norm() > 0.0 ? w.normalized() : Eigen::Vector3d::UnitX();
    CHECK((R - Eigen::AngleAxisd(w.norm(), axis).toRotationMatrix()).norm() < 1e-14);
    CHECK(std::abs(exp_so3(w).norm() - 1.0) < 1e-15);
  }
}

TEST_CASE("the logarithm map is the inverse of the exponential map and Eigen's angle times axis") {
  for (const Eigen::Vector3d& w : rotation_vectors()) {
    const Eigen::Quaterniond q = exp_so3(w);
    CHECK((log_so3(q) - w).norm() <= 1e-15 + 1e-15 * w.norm());
    const Eigen::Quaterniond other(-q.w(), -q.x(), -q.y(), -q.z());  // the same rotation
    CHECK((log_so3(other) - w).norm() <= 1e-15 + 1e-15 * w.norm());
    const Eigen::AngleAxisd turn(q);
    CHECK((log_so3(q) - turn.angle() * turn.axis()).norm() <= 1e-15 * w.norm());
    CHECK(std::abs(rotation_angle_rad(q) - w.norm()) <= 1e-15 + 1e-15 * w.norm());
  }
}

TEST_CASE("roll, pitch, yaw are rotations about fixed axes, in that order, and yaw_of() finds the yaw") {
  const Eigen::Vector3d rpy(0.3, -0.7, 2.0);
  const Eigen::Matrix3d expected = rotation_about_z(rpy.z()) *
                                   Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
  CHECK((rotation_from_rpy(rpy).toRotationMatrix() - expected).norm() < 1e-15);
  CHECK((rotation_from_rpy_deg(rpy / kRadPerDeg) - expected).norm() < 1e-15);
  CHECK(yaw_of(rotation_from_rpy(rpy)) == doctest::Approx(2.0).epsilon(1e-14));
}

TEST_CASE("the nearest rotation about z is the yaw of a small tilt, and maximises the trace") {
  const Eigen::Matrix3d R = rotation_from_rpy({0.2, -0.1, 1.2}).toRotationMatrix();
  const Eigen::Matrix3d nearest = nearest_rotation_about_z(R);
  const double trace = (nearest.transpose() * R).trace();
  for (const double turn_rad : {-0.01, 0.01}) {
    CHECK((rotation_about_z(turn_rad) * nearest).cwiseProduct(R).sum() < trace);
  }
  CHECK((nearest_rotation_about_z(rotation_about_z(1.2)) - rotation_about_z(1.2)).norm() < 1e-15);
}

}  // namespace isobar::test::test_so3
