// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/graph/altitude_factor.hpp"
#include "core/graph/pose_prior.hpp"
#include "core/graph/relative_pose_edge.hpp"
#include "core/graph/rotation_error.hpp"
#include "core/graph/stationary_ground.hpp"
#include "core/graph/whitening.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_factors {

namespace {

// Central differences: the error of the formula is the third derivative times h^2 / 6, that of rounding 1e-16 / h.
constexpr double kStep = 1e-5;
constexpr double kTolerance = 1e-8;  // errors and derivatives here are up to 30

class Poses {
 public:
  Eigen::Isometry3d pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = exp_so3(vector(1.0)).toRotationMatrix();
    T.translation() = vector(10.0);
    return T;
  }
  Eigen::Vector3d vector(double sigma) {
    return sigma * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
  }

 private:
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_{0.0, 1.0};
};

// Derivative of `error(step)` by the step.
template <int Rows, class Error>
NodeJacobian<Rows> numeric(const Error& error) {
  NodeJacobian<Rows> J;
  for (int k = 0; k < 7; ++k) {
    const NodeStep step = kStep * NodeStep::Unit(k);
    J.col(k) = (error(step) - error(-step)) / (2.0 * kStep);
  }
  return J;
}

using One = Eigen::Matrix<double, 1, 1>;

}  // namespace

TEST_CASE("the Jacobians of a relative pose are its derivatives, for errors of any size") {
  Poses poses;
  for (const double off : {0.0, 1e-6, 0.01, 0.5}) {
    for (int i = 0; i < 10; ++i) {
      const Eigen::Isometry3d T_a = poses.pose();
      const Eigen::Isometry3d T_b = poses.pose();
      NodeStep shift = NodeStep::Zero();
      shift.head<3>() = off * poses.vector(1.0);
      shift.segment<3>(3) = off * poses.vector(1.0);
      const Eigen::Isometry3d T_ab = moved(T_a.inverse() * T_b, shift);
      const RelativePoseError e = linearised_relative_pose(T_a, T_b, T_ab);
      const auto by_a =
          numeric<6>([&](const NodeStep& s) { return relative_pose_error(moved(T_a, s), T_b, T_ab); });
      const auto by_b =
          numeric<6>([&](const NodeStep& s) { return relative_pose_error(T_a, moved(T_b, s), T_ab); });
      CHECK((e.by_from - by_a).cwiseAbs().maxCoeff() < kTolerance);
      CHECK((e.by_to - by_b).cwiseAbs().maxCoeff() < kTolerance);
      CHECK(e.error == relative_pose_error(T_a, T_b, T_ab));
    }
  }
}

TEST_CASE(
    "the error of a relative pose is zero for the pose itself, and a shift or a turn in the axes of `from`") {
  Poses poses;
  const Eigen::Isometry3d T_a = poses.pose();
  const Eigen::Isometry3d T_ab = poses.pose();
  CHECK(relative_pose_error(T_a, T_a * T_ab, T_ab).norm() < 1e-14);  // rounding of tens of metres
  Vector6d off;
  off << 0.3, -0.2, 0.1, 0.02, -0.05, 0.4;
  Eigen::Isometry3d T_off = T_ab;
  T_off.translation() += off.head<3>();
  T_off.linear() = (exp_so3(off.tail<3>()) * T_ab.linear()).eval();
  CHECK((relative_pose_error(T_a, T_a * T_off, T_ab) - off).norm() < 1e-14);
}

TEST_CASE("the Jacobian of a prior is its derivative") {
  Poses poses;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Isometry3d T = poses.pose();
    const Eigen::Isometry3d T_known = poses.pose();
    const auto error = [&](const NodeStep& s) { return prior_error(moved(T, s), T_known); };
    // Rotations by up to pi: the inverse left Jacobian grows towards 2 pi.
    CHECK((prior_jacobian(prior_error(T, T_known)) - numeric<6>(error)).cwiseAbs().maxCoeff() <
          10.0 * kTolerance);
  }
}

TEST_CASE("the Jacobians of altitude, bias and ground are their derivatives") {
  const AltitudeFactor altitude{0, 4.0, 0.05};
  const BiasLink link{0.9, 0.1};
  const StationaryGround ground{0, 1, 0.02};
  const auto by_altitude =
      numeric<1>([&](const NodeStep& s) { return One(altitude_error(altitude, 3.0 + s(2), 0.5 + s(6))); });
  const auto by_earlier =
      numeric<1>([&](const NodeStep& s) { return One(bias_error(link, 0.2 + s(6), 0.5)); });
  const auto by_later = numeric<1>([&](const NodeStep& s) { return One(bias_error(link, 0.2, 0.5 + s(6))); });
  const auto by_a = numeric<1>([&](const NodeStep& s) { return One(ground_error(ground, 0.2 + s(2), 0.5)); });
  const auto by_b = numeric<1>([&](const NodeStep& s) { return One(ground_error(ground, 0.2, 0.5 + s(2))); });
  CHECK((altitude_jacobian(altitude) - by_altitude).norm() < kTolerance);
  CHECK((bias_jacobian(-link.phi / link.sigma_m) - by_earlier).norm() < kTolerance);
  CHECK((bias_jacobian(1.0 / link.sigma_m) - by_later).norm() < kTolerance);
  CHECK((ground_jacobian(ground) - by_a).norm() < kTolerance);
  CHECK((ground_jacobian(ground) + by_b).norm() < kTolerance);
}

TEST_CASE(
    "the bias keeps its variance over any time, forgets over a long one, and walks without a base station") {
  AltimeterBias bias;
  for (const double dt_s : {0.0, 1.0, 60.0, 450.0, 1e5}) {
    const BiasLink link = bias_link(bias, dt_s);
    const double variance_m2 = squared(link.phi * bias.sigma_m) + squared(link.sigma_m);
    CHECK(std::sqrt(variance_m2) ==
          doctest::Approx(bias.sigma_m).epsilon(1e-6));  // but for kLeastBiasChangeM
  }
  CHECK(bias_link(bias, 1e5).phi < 1e-90);
  bias.weather_walk_m_sqrt_s = 0.02;
  CHECK(bias_link(bias, 3600.0).phi == 1.0);
  CHECK(bias_link(bias, 3600.0).sigma_m == doctest::Approx(std::hypot(0.02 * 60.0, 0.15)).epsilon(1e-6));
}

TEST_CASE(
    "a whitened error has the length of the covariance's distance, with gravity of x, y, z and yaw alone") {
  Eigen::Matrix<double, 6, 6> A;
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (double& value : A.reshaped()) value = normal(random);
  const Matrix6d covariance = A * A.transpose() + Matrix6d::Identity();
  Vector6d e;
  e << 0.3, -1.0, 2.0, 0.7, -0.4, 0.9;
  const auto full = whitening(covariance, false);
  REQUIRE(full.has_value());
  CHECK((*full * e).squaredNorm() == doctest::Approx(e.dot(covariance.inverse() * e)).epsilon(1e-12));
  Matrix6d without_tilt = covariance;
  without_tilt.middleRows<2>(3).setZero();
  without_tilt.middleCols<2>(3).setZero();
  const Eigen::Matrix4d marginal = covariance(kLevelRows, kLevelRows);
  const Eigen::Vector4d level_e = e(kLevelRows);
  const auto level = whitening(without_tilt, true);
  REQUIRE(level.has_value());
  CHECK((*level * e).squaredNorm() ==
        doctest::Approx(level_e.dot(marginal.inverse() * level_e)).epsilon(1e-12));
  CHECK_FALSE(whitening(without_tilt, false).has_value());
  CHECK_FALSE(whitening(-covariance, true).has_value());
  CHECK_FALSE(whitening(NAN * covariance, false).has_value());
}

}  // namespace isobar::test::test_factors
