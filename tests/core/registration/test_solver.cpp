// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "core/registration/point_to_plane.hpp"
#include "core/registration/solver.hpp"

namespace isobar::test::test_solver {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

// Pairs of a room with all directions of walls, displaced by a small twist.
std::vector<Pair> room_pairs(const Vector6d& displacement) {
  std::mt19937 random(21);
  std::uniform_real_distribution<float> place(-4.0F, 4.0F);
  std::vector<Pair> pairs;
  for (int i = 0; i < 600; ++i) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    normal(i % 3) = i % 2 == 0 ? 1.0F : -1.0F;
    const Eigen::Vector3f p(place(random), place(random), 0.4F * place(random));
    Pair pair{p, normal, 0.0F};
    const Eigen::Vector3d moved = displacement.head<3>().cross(p.cast<double>()) + displacement.tail<3>();
    pair.residual_m = normal.dot(moved.cast<float>());
    pairs.push_back(pair);
  }
  return pairs;
}

NormalEquations equations_of(const std::vector<Pair>& pairs) {
  return accumulate(pairs, PairNoise{}, 10.0F);  // a loss so wide that all weights are one
}

Basis basis_of(Method method) { return traits_of(method, HeightSource::kDifferential).basis; }

Vector6d twist(double wx, double wy, double wz, double x, double y, double z) {
  Vector6d t;
  t << wx, wy, wz, x, y, z;
  return t;
}

}  // namespace

TEST_CASE("without a prior each basis finds a displacement in its span, and nothing else") {
  const Vector6d yaw_xy = twist(0.0, 0.0, 0.01, 0.03, -0.02, 0.0);
  const Vector6d yaw_xyz = twist(0.0, 0.0, 0.01, 0.03, -0.02, 0.05);
  const Vector6d full = twist(0.004, -0.006, 0.01, 0.03, -0.02, 0.05);
  const struct {
    Method method;
    Vector6d displacement;
  } cases[] = {{Method::k3Dof, yaw_xy}, {Method::k4Dof, yaw_xyz}, {Method::k6Dof, full}};
  for (const auto& [method, displacement] : cases) {
    const Step step =
        solve_step(equations_of(room_pairs(displacement)), PriorTerm{}, basis_of(method), SolverWeights{});
    REQUIRE(step.solved);
    // The system is linear; single precision of the residuals leaves 1e-6.
    CHECK((step.twist + displacement).norm() < 1e-5);
    CHECK(step.directions[0].strength > 0.99);
  }
}

TEST_CASE("3-DOF solves the paper's equation (12)") {
  const std::vector<Pair> pairs = room_pairs(twist(0.004, -0.006, 0.01, 0.03, -0.02, 0.05));
  // (sum a a^T) tau = sum (n^T d) a, with d = q - p, summed independently.
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d p = pair.p_robot.cast<double>();
    const Eigen::Vector3d n = pair.normal.cast<double>();
    const Eigen::Vector3d a(n.dot(Eigen::Vector3d::UnitZ().cross(p)), n.x(), n.y());
    A += a * a.transpose();
    b -= pair.residual_m * a;
  }
  const Eigen::Vector3d tau = A.inverse() * b;
  const Step step = solve_step(equations_of(pairs), PriorTerm{}, basis_of(Method::k3Dof), SolverWeights{});
  REQUIRE(step.solved);
  CHECK((step.twist.segment<3>(2) - tau).norm() < 1e-6);
  CHECK(step.twist.head<2>().norm() + std::abs(step.twist(5)) == 0.0);
}

TEST_CASE("a penalty on height, roll and pitch goes from free to fixed as its sigma falls") {
  const NormalEquations equations = equations_of(room_pairs(twist(0.004, -0.006, 0.01, 0.03, -0.02, 0.05)));
  const Step constrained = solve_step(equations, PriorTerm{}, basis_of(Method::k3Dof), SolverWeights{});
  const Step free = solve_step(equations, PriorTerm{}, basis_of(Method::k6Dof), SolverWeights{});
  const auto penalised = [&](double sigma) {
    PriorTerm prior;
    for (const int fixed : {0, 1, 5}) {
      prior.information(fixed, fixed) = 1.0 / (sigma * sigma);
    }
    return solve_step(equations, prior, basis_of(Method::k6Dof), SolverWeights{});
  };
  // 600 pairs against sigma^-2: the distance to either limit is about 600 sigma^2 or its inverse, times 0.05.
  CHECK((penalised(1e-5).twist - constrained.twist).norm() < 1e-6);
  CHECK((penalised(1e4).twist - free.twist).norm() < 1e-6);
  const double between = penalised(0.05).twist(5);
  CHECK(between < constrained.twist(5) - 1e-3);
  CHECK(between > free.twist(5) + 1e-3);
}

TEST_CASE("the step minimises the sum of scan and prior terms") {
  const NormalEquations equations = equations_of(room_pairs(twist(0.0, 0.0, 0.01, 0.03, -0.02, 0.05)));
  PriorTerm prior;
  prior.deviation = twist(0.0, 0.0, 0.02, -0.01, 0.04, 0.0);
  prior.information.diagonal() << 1.0, 1.0, 5000.0, 300.0, 100.0, 50.0;
  SolverWeights weights;
  weights.pair_information = 2.0;
  const Basis basis = basis_of(Method::k6Dof);
  const Step step = solve_step(equations, prior, basis, weights);
  const auto cost = [&](const Vector6d& t) {
    const Vector6d off = prior.deviation + t;
    return weights.pair_information * (t.dot(equations.hessian * t) + 2.0 * t.dot(equations.gradient)) +
           off.dot(prior.information * off);
  };
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1e-3);
  const double least = cost(step.twist);
  for (int i = 0; i < 100; ++i) {
    Vector6d other = step.twist;
    for (int k = 0; k < 6; ++k) {
      other(k) += normal(random);
    }
    CHECK(cost(other) > least);
  }
}

TEST_CASE("the solution is frame-invariant: it rotates with the map's axes") {
  const Vector6d displacement = twist(0.004, -0.006, 0.01, 0.03, -0.02, 0.05);
  std::vector<Pair> pairs = room_pairs(displacement);
  const Step here = solve_step(equations_of(pairs), PriorTerm{}, basis_of(Method::k6Dof), SolverWeights{});
  const Eigen::Matrix3f R =
      Eigen::AngleAxisf(1.1F, Eigen::Vector3f(1.0F, 2.0F, 3.0F).normalized()).toRotationMatrix();
  for (Pair& pair : pairs) {
    pair.p_robot = R * pair.p_robot;
    pair.normal = R * pair.normal;
  }
  const Step there = solve_step(equations_of(pairs), PriorTerm{}, basis_of(Method::k6Dof), SolverWeights{});
  CHECK((R.cast<double>() * here.twist.head<3>() - there.twist.head<3>()).norm() < 1e-5);
  CHECK((R.cast<double>() * here.twist.tail<3>() - there.twist.tail<3>()).norm() < 1e-5);
}

TEST_CASE("a direction that no surface constrains is weak, and follows the prior") {
  // Side walls, floor and ceiling of a corridor along x; normals err by 0.5 degrees, spurious information in
  // x.
  std::mt19937 random(9);
  std::normal_distribution<float> error(0.0F, 0.009F);
  std::uniform_real_distribution<float> along(-10.0F, 10.0F);
  std::vector<Pair> pairs;
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    normal(1 + i % 2) = 1.0F;
    normal.x() = error(random);
    const float lateral = i % 4 < 2 ? 1.2F : -1.2F;
    const Eigen::Vector3f p(along(random), lateral, i % 2 == 0 ? 0.5F : lateral);
    pairs.push_back({p, normal.normalized(), 0.0F});
  }
  PriorTerm prior;
  prior.deviation(3) = 0.02;
  prior.deviation(4) = 0.02;
  prior.information.diagonal().setConstant(1.0 / (0.05 * 0.05));
  SolverWeights weights;
  weights.pair_information = 1.0 / (15.0 * 0.02 * 0.02);
  weights.normal_variance = std::pow(std::sin(1.5 * 3.14159265 / 180.0), 2);
  weights.correlated_pairs = 15.0;
  const Step step = solve_step(equations_of(pairs), prior, basis_of(Method::k3Dof), weights);
  REQUIRE(step.solved);
  CHECK(step.directions[0].strength < 0.01);
  CHECK(std::abs(step.directions[0].axis(3)) > 0.99);
  CHECK(step.directions[1].strength > 0.99);
  // Along x only the prior counts, across the walls.
  CHECK(step.twist(3) == doctest::Approx(-0.02).epsilon(0.01).scale(0.0));
  CHECK(std::abs(step.twist(4)) < 0.001);
  CHECK(step.covariance(3, 3) == doctest::Approx(0.05 * 0.05).epsilon(0.01));
  CHECK(step.covariance(4, 4) < 1e-4);
}

TEST_CASE("without pairs the step is the prior's; without pairs and prior there is none") {
  PriorTerm prior;
  prior.deviation = twist(0.0, 0.0, 0.1, 0.2, 0.3, 0.0);
  prior.information.setIdentity();
  const Step step = solve_step(NormalEquations{}, prior, basis_of(Method::k3Dof), SolverWeights{});
  REQUIRE(step.solved);
  CHECK((step.twist + prior.deviation).norm() < 1e-12);
  CHECK(step.directions[0].strength == 0.0);
  CHECK_FALSE(solve_step(NormalEquations{}, PriorTerm{}, basis_of(Method::k3Dof), SolverWeights{}).solved);
  NormalEquations poisoned = equations_of(room_pairs(Vector6d::Zero()));
  poisoned.gradient(3) = std::nan("");
  CHECK_FALSE(solve_step(poisoned, prior, basis_of(Method::k3Dof), SolverWeights{}).solved);
}

// Prior of standard deviation `sigma` (rad, m) in roll, pitch and z, and none in the other directions.
PriorTerm tilt_and_height_prior(double sigma) {
  PriorTerm prior;
  for (const int direction : {0, 1, 5}) prior.information(direction, direction) = 1.0 / (sigma * sigma);
  return prior;
}

TEST_CASE(
    "a penalty on roll, pitch and z is 3-DOF where its sigma goes to zero, and 6-DOF where it goes to "
    "infinity") {
  const NormalEquations equations = equations_of(room_pairs(twist(0.004, -0.003, 0.01, 0.03, -0.02, 0.05)));
  const Vector6d soft =
      solve_step(equations, tilt_and_height_prior(1e-7), basis_of(Method::kAdaptive), {}).twist;
  const Vector6d fixed = solve_step(equations, PriorTerm{}, basis_of(Method::k3Dof), {}).twist;
  // 600 pairs of information 1 against 1e14: the penalised directions keep 1e-11 of their displacement.
  CHECK((soft - fixed).cwiseAbs().maxCoeff() < 1e-8);
  const Vector6d loose =
      solve_step(equations, tilt_and_height_prior(1e6), basis_of(Method::kAdaptive), {}).twist;
  const Vector6d free = solve_step(equations, PriorTerm{}, basis_of(Method::k6Dof), {}).twist;
  CHECK((loose - free).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("a penalty on roll and pitch alone is 4-DOF where its sigma goes to zero") {
  const NormalEquations equations = equations_of(room_pairs(twist(0.004, -0.003, 0.01, 0.03, -0.02, 0.05)));
  PriorTerm prior = tilt_and_height_prior(1e-7);
  prior.information(5, 5) = 0.0;
  const Vector6d soft = solve_step(equations, prior, basis_of(Method::kAdaptive), {}).twist;
  const Vector6d fixed = solve_step(equations, PriorTerm{}, basis_of(Method::k4Dof), {}).twist;
  CHECK((soft - fixed).cwiseAbs().maxCoeff() < 1e-8);
}

}  // namespace isobar::test::test_solver
