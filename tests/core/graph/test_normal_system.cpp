// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "core/graph/normal_system.hpp"

namespace isobar::test::test_normal_system {

namespace {

// Normal equations of random factors, sparse and dense: 7 unknowns a node in the dense ones.
struct Sums {
  std::vector<NodeFreedom> freedom;
  std::vector<NodePair> ties;
  NormalSystem sparse;
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
  std::mt19937 random{9};
  std::normal_distribution<double> normal{0.0, 1.0};

  explicit Sums(int nodes)
      : H(Eigen::MatrixXd::Zero(7 * nodes, 7 * nodes)), g(Eigen::VectorXd::Zero(7 * nodes)) {
    for (int n = 0; n < nodes; ++n) {
      freedom.push_back(freedom_of(n == 3, n % 2 == 0, n % 3 == 0));
      if (n > 0) ties.emplace_back(n - 1, n);
    }
    for (const int n : {0, 5, 6}) ties.emplace_back(nodes - 1 - n, n);
    sparse.restructure(freedom, ties);
    for (const auto& [a, b] : ties) add(a, b);
    for (int n = 0; n < nodes; ++n) add(n, n);
  }

  NodeJacobian<6> jacobian() {
    NodeJacobian<6> J;
    for (double& value : J.reshaped()) value = normal(random);
    return J;
  }

  void add(int a, int b) {
    const NodeJacobian<6> J_a = jacobian();
    const NodeJacobian<6> J_b = jacobian();
    const Vector6d error = J_a.col(0) - J_b.col(3);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, g.size());
    J.middleCols<7>(7 * a) = J_a;
    if (a == b) {
      sparse.add<6>(error, {a, J_a});
    } else {
      J.middleCols<7>(7 * b) = J_b;
      sparse.add<6>(error, {a, J_a}, {b, J_b});
    }
    H += J.transpose() * J;
    g += J.transpose() * error;
  }

  // Columns of the dense system that are unknown.
  [[nodiscard]] std::vector<int> unknowns() const {
    std::vector<int> all;
    for (std::size_t n = 0; n < freedom.size(); ++n) {
      for (int i = 0; i < freedom[n].count; ++i) {
        all.push_back(static_cast<int>(7 * n) + freedom[n].columns[static_cast<std::size_t>(i)]);
      }
    }
    return all;
  }
};

constexpr double kTolerance = 1e-4;  // the information that each unknown has by itself is 1e-6 of a factor's

}  // namespace

TEST_CASE("steps are those of the dense normal equations, and zero in fixed directions") {
  Sums sums(20);
  REQUIRE(sums.sparse.factorise(0.0));
  std::vector<NodeStep> steps;
  sums.sparse.solve(steps);
  const std::vector<int> free = sums.unknowns();
  CHECK(sums.sparse.unknowns() == static_cast<Eigen::Index>(free.size()));
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(sums.g.size());
  expected(free) = -Eigen::MatrixXd(sums.H(free, free)).ldlt().solve(Eigen::VectorXd(sums.g(free)));
  for (int n = 0; n < 20; ++n) {
    CHECK((steps[static_cast<std::size_t>(n)] - expected.segment<7>(7 * n)).norm() < kTolerance);
    CHECK((steps[static_cast<std::size_t>(n)].array() == 0.0).count() ==
          7 - sums.freedom[static_cast<std::size_t>(n)].count);
  }
}

TEST_CASE("the marginal covariance of two nodes is that of the dense inverse, each time it is asked") {
  Sums sums(20);
  REQUIRE(sums.sparse.factorise(0.0));
  const std::vector<int> free = sums.unknowns();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(sums.g.size(), sums.g.size());
  const Eigen::MatrixXd part = Eigen::MatrixXd(sums.H(free, free)).inverse();
  inverse(free, free) = part;
  for (const auto& [a, b] : std::vector<NodePair>{{0, 19}, {19, 0}, {7, 8}, {3, 12}, {12, 3}, {5, 5}}) {
    const NodeJacobian<6> J_a = sums.jacobian();
    const NodeJacobian<6> J_b = sums.jacobian();
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, sums.g.size());
    J.middleCols<7>(7 * a) += J_a;
    J.middleCols<7>(7 * b) += J_b;
    const Matrix6d expected = J * inverse * J.transpose();
    CHECK((sums.sparse.marginal({a, J_a}, {b, J_b}) - expected).norm() < kTolerance * expected.norm());
  }
}

TEST_CASE("damping shortens the step; a sum that is not finite is not factorised") {
  Sums sums(8);
  std::vector<NodeStep> free;
  std::vector<NodeStep> damped;
  REQUIRE(sums.sparse.factorise(0.0));
  sums.sparse.solve(free);
  REQUIRE(sums.sparse.factorise(1e3));
  sums.sparse.solve(damped);
  for (std::size_t n = 0; n < free.size(); ++n) CHECK(damped[n].norm() <= 0.1 * free[n].norm());
  const Vector6d error = Vector6d::Constant(NAN);
  const NodeJacobian<6> J = NodeJacobian<6>::Ones();
  sums.sparse.add<6>(error, {0, J});
  CHECK_FALSE(sums.sparse.factorise(0.0));
}

}  // namespace isobar::test::test_normal_system
