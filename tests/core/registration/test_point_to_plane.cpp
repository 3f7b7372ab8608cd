// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/registration/point_to_plane.hpp"

namespace isobar::test::test_point_to_plane {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

Eigen::Vector3f random_vector(std::mt19937& random, float scale) {
  std::normal_distribution<float> normal(0.0F, scale);
  return {normal(random), normal(random), normal(random)};
}

// Equation (8)'s error of one pair after a twist, in double precision.
double error_after(const Pair& pair, const Vector6d& twist) {
  const Eigen::Vector3d omega = twist.head<3>();
  const double angle = omega.norm();
  Eigen::Vector3d p = pair.p_robot.cast<double>();
  if (angle > 0.0) {
    p = Eigen::AngleAxisd(angle, omega / angle) * p;
  }
  const Eigen::Vector3d moved = p + twist.tail<3>() - pair.p_robot.cast<double>();
  return pair.residual_m + pair.normal.cast<double>().dot(moved);
}

// The Jacobian that the solver uses: the gradient of one pair is w J e.
Vector6d solver_jacobian(const Pair& pair) {
  const NormalEquations sum = accumulate({&pair, 1}, PairNoise{}, 1.0F);
  return sum.gradient / (sum.weight_sum * pair.residual_m);
}

// Closed form of the Jacobian in double precision: (p x n, n).
Vector6d closed_form_jacobian(const Pair& pair) {
  const Eigen::Vector3d n = pair.normal.cast<double>();
  Vector6d jacobian;
  jacobian << pair.p_robot.cast<double>().cross(n), n;
  return jacobian;
}

}  // namespace

TEST_CASE("the Jacobian in the normal equations equals the numerical derivative") {
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const Pair pair{random_vector(random, 5.0F), random_vector(random, 1.0F).normalized(), 0.1F};
    const Vector6d jacobian = solver_jacobian(pair);
    for (int k = 0; k < 6; ++k) {
      constexpr double kStep = 1e-5;
      Vector6d twist = Vector6d::Zero();
      twist(k) = kStep;
      const double up = error_after(pair, twist);
      twist(k) = -kStep;
      const double numeric = (up - error_after(pair, twist)) / (2.0 * kStep);
      // Central differences err by the square of the step; single precision of p x n and of w J e by 1e-6.
      CHECK(std::abs(jacobian(k) - numeric) < 1e-4);
    }
  }
}

TEST_CASE("rows yaw, x and y of the Jacobian are a_k of the paper's equation (10)") {
  std::mt19937 random(12);
  const Pair pair{random_vector(random, 5.0F), random_vector(random, 1.0F).normalized(), 0.1F};
  const Vector6d jacobian = solver_jacobian(pair);
  const Eigen::Vector3f turned = Eigen::Vector3f::UnitZ().cross(pair.p_robot);
  CHECK(jacobian(2) == doctest::Approx(pair.normal.dot(turned)).epsilon(1e-4));
  CHECK(jacobian(3) == doctest::Approx(pair.normal.x()).epsilon(1e-4));
  CHECK(jacobian(4) == doctest::Approx(pair.normal.y()).epsilon(1e-4));
}

TEST_CASE("the scale is the standard deviation of the inliers despite a tenth of outliers") {
  std::mt19937 random(13);
  std::normal_distribution<float> noise(0.0F, 0.05F);
  std::vector<Pair> pairs;
  for (int i = 0; i < 4000; ++i) {
    const float residual = i % 10 == 0 ? 0.45F : noise(random);
    pairs.push_back({random_vector(random, 3.0F), Eigen::Vector3f::UnitX(), residual});
  }
  // A tenth of outliers moves the median of absolute values from 0.674 to about 0.77 deviations.
  CHECK(residual_scale_m(pairs, PairNoise{}, 0.5F) ==
        doctest::Approx(0.05 * 0.77 / 0.674).epsilon(0.06).scale(0.0));
}

TEST_CASE("a tenth of far outliers does not shift the minimum away from the wall") {
  std::vector<Pair> pairs;
  for (int i = 0; i < 100; ++i) {
    pairs.push_back({Eigen::Vector3f(1.0F, 0.1F * static_cast<float>(i), 0.0F), Eigen::Vector3f::UnitX(),
                     i % 10 == 0 ? 0.5F : 0.02F});
  }
  const NormalEquations sum = accumulate(pairs, PairNoise{}, 0.02F);
  const double step = -sum.gradient(3) / sum.hessian(3, 3);
  // Least squares would give -0.068; the outliers' weights are (1 + (0.5 / 0.06)^2)^-2 = 2e-4.
  CHECK(step == doctest::Approx(-0.02).epsilon(0.05).scale(0.0));
}

TEST_CASE("a pair has weight one if it does not depend on the fixed height, and a smaller one if it does") {
  PairNoise noise;
  noise.pose_variance(5) = 0.06F * 0.06F;
  noise.noise_m = 0.02F;
  const std::vector<Pair> wall{{Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitX(), 0.0F}};
  const std::vector<Pair> ramp{{Eigen::Vector3f::UnitX(), Eigen::Vector3f(0.6F, 0.0F, 0.8F), 0.0F}};
  CHECK(accumulate(wall, noise, 0.02F).weight_sum == doctest::Approx(1.0));
  // Variance 0.02^2 + (0.8 * 0.06)^2 in units of 0.02^2.
  CHECK(accumulate(ramp, noise, 0.02F).weight_sum == doctest::Approx(1.0 / (1.0 + 0.64 * 9.0)));
}

TEST_CASE("the sums equal those of a plain loop in double precision, for any number of pairs") {
  std::mt19937 random(14);
  PairNoise noise;
  noise.pose_variance << 1e-4F, 2e-4F, 0.0F, 0.0F, 0.0F, 9e-4F;
  constexpr double kScaleM = 0.03;
  for (const int count : {0, 1, 63, 64, 65, 128, 1'801}) {
    std::vector<Pair> pairs;
    NormalEquations expected;
    Matrix6d sizes = Matrix6d::Zero();
    for (int i = 0; i < count; ++i) {
      pairs.push_back({random_vector(random, 8.0F), random_vector(random, 1.0F).normalized(),
                       random_vector(random, 0.05F).x()});
      const Vector6d jacobian = closed_form_jacobian(pairs.back());
      const double variance =
          1.0 + jacobian.cwiseAbs2().dot(noise.pose_variance.cast<double>()) / (0.02 * 0.02);
      const double error2 = static_cast<double>(pairs.back().residual_m) * pairs.back().residual_m;
      const double loss = 1.0 + error2 / (variance * 9.0 * kScaleM * kScaleM);
      const double weight = 1.0 / (loss * loss * variance);
      expected.hessian += weight * jacobian * jacobian.transpose();
      sizes += weight * jacobian.cwiseAbs() * jacobian.cwiseAbs().transpose();
      expected.gradient += weight * pairs.back().residual_m * jacobian;
      expected.weight_sum += weight;
      expected.squared_error_sum += weight * error2;
      expected.squared_lever_sum += weight * pairs.back().p_robot.cast<double>().squaredNorm();
    }
    const NormalEquations sum = accumulate(pairs, noise, static_cast<float>(kScaleM));
    // Single precision: 1e-7 a step, a dozen steps a term and 64 addends at most; signs may cancel.
    constexpr double kShare = 1e-5;
    CHECK(((sum.hessian - expected.hessian).cwiseAbs() - kShare * sizes).maxCoeff() <= 0.0);
    CHECK((sum.hessian - sum.hessian.transpose()).cwiseAbs().maxCoeff() == 0.0);
    CHECK((sum.gradient - expected.gradient).norm() <= kShare * 0.05 * sizes.diagonal().sum());
    CHECK(sum.weight_sum == doctest::Approx(expected.weight_sum).epsilon(kShare));
    CHECK(sum.squared_error_sum == doctest::Approx(expected.squared_error_sum).epsilon(kShare));
    CHECK(sum.squared_lever_sum == doctest::Approx(expected.squared_lever_sum).epsilon(kShare));
  }
}

TEST_CASE("the scale does not depend on the order of the pairs; without pairs it is the smallest") {
  std::mt19937 random(15);
  PairNoise noise;
  noise.pose_variance << 1e-4F, 1e-4F, 0.0F, 0.0F, 0.0F, 4e-4F;
  std::vector<Pair> pairs;
  for (int i = 0; i < 777; ++i) {
    pairs.push_back({random_vector(random, 3.0F), random_vector(random, 1.0F).normalized(),
                     random_vector(random, 0.06F).x()});
  }
  const float scale_m = residual_scale_m(pairs, noise, 0.5F);
  std::shuffle(pairs.begin(), pairs.end(), random);
  // Sums of single precision in another order.
  CHECK(residual_scale_m(pairs, noise, 0.5F) == doctest::Approx(scale_m).epsilon(1e-4));
  CHECK(residual_scale_m({}, noise, 0.5F) == doctest::Approx(noise.noise_m));
}

}  // namespace isobar::test::test_point_to_plane
