// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/loops/loop.hpp"
#include "core/loops/loop_evidence.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_loop_evidence {
namespace {

LoopEvidence evidence(double way_m, double x_m, double y_m = 0.0) {
  LoopEvidence evidence;
  evidence.loop.way_m = way_m;
  evidence.shift = {x_m, y_m, 0.0, 0.0};
  evidence.covariance = Eigen::Matrix4d::Identity() * 0.05 * 0.05;
  return evidence;
}

TEST_CASE("a loop waits for a second one that moves the robot alike") {
  LoopPairs pairs;
  CHECK(pairs.add(evidence(10.0, 0.4)).empty());
  const auto accepted = pairs.add(evidence(12.0, 0.42));
  REQUIRE(accepted.size() == 2);
  CHECK(accepted[0].way_m == 10.0);
  CHECK(accepted[1].way_m == 12.0);
  CHECK(pairs.add(evidence(14.0, 0.41)).size() == 1);  // the first two are accepted already
}

TEST_CASE("loops that move the robot differently confirm nothing") {
  LoopPairs pairs;
  CHECK(pairs.add(evidence(10.0, 0.4)).empty());
  CHECK(pairs.add(evidence(12.0, -0.4)).empty());
  CHECK(pairs.add(evidence(14.0, 0.4, 0.8)).empty());
}

TEST_CASE(
    "loops of nearly one place share what misleads them, and those far apart the drift between: no pair") {
  LoopPairs pairs;
  CHECK(pairs.add(evidence(10.0, 0.4)).empty());
  CHECK(pairs.add(evidence(10.0 + 0.9 * LoopPairs::kLeastWayM, 0.4)).empty());
  LoopPairs far;
  CHECK(far.add(evidence(10.0, 0.4)).empty());
  CHECK(far.add(evidence(10.0 + 1.1 * LoopPairs::kMostWayM, 0.4)).empty());
}

TEST_CASE("a direction that the scans leave open may differ between the two") {
  LoopPairs pairs;
  LoopEvidence first = evidence(10.0, 0.4);
  LoopEvidence second = evidence(12.0, -0.6);
  first.covariance(0, 0) = second.covariance(0, 0) = 1.0;  // along a corridor
  CHECK(pairs.add(first).empty());
  CHECK(pairs.add(second).size() == 2);
}

TEST_CASE(
    "the covariance of the holder's pose is that of the key scan's, carried over the lever: closed form of "
    "samples") {
  Loop loop;
  loop.T_submap_base = Eigen::Translation3d(4.0, 1.0, 0.5) * rotation_from_rpy({0.0, 0.0, 0.7});
  loop.T_holder_base = Eigen::Translation3d(-6.0, 3.0, 0.2) * rotation_from_rpy({0.0, 0.0, -0.4});
  loop.covariance.diagonal() << 1e-4, 4e-4, 1e-4, 1e-6, 1e-6, 9e-6;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Eigen::Isometry3d T_holder = loop.T_submap_holder();
  Matrix6d sampled = Matrix6d::Zero();
  constexpr int kSamples = 20'000;
  for (int i = 0; i < kSamples; ++i) {
    Eigen::Matrix<double, 6, 1> error;
    for (int k = 0; k < 6; ++k) error(k) = normal(random) * std::sqrt(loop.covariance(k, k));
    Eigen::Isometry3d T_base = loop.T_submap_base;
    T_base.translation() += error.head<3>();
    T_base.linear() = exp_so3(error.tail<3>()).toRotationMatrix() * T_base.linear();
    const Eigen::Isometry3d T = T_base * loop.T_holder_base.inverse();
    Eigen::Matrix<double, 6, 1> moved;
    moved << T.translation() - T_holder.translation(),
        log_so3(Eigen::Quaterniond(T.linear() * T_holder.linear().transpose()));
    sampled += moved * moved.transpose() / kSamples;
  }
  // 20 000 samples know a variance to 1 %; five sigma.
  const Matrix6d difference = sampled - loop.holder_covariance();
  CHECK(difference.norm() < 0.05 * loop.holder_covariance().norm());
}

}  // namespace
}  // namespace isobar::test::test_loop_evidence
