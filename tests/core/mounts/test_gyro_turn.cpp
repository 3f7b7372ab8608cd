// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/mounts/gyro_turn.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_gyro_turn {

namespace {

constexpr std::int64_t kMs = 1'000'000;

// Priors every 5 ms from 0 to 1 s that turn about a constant axis.
PriorHistory turning(const Eigen::Vector3d& w_base_rad_s, std::int64_t step_ns = 5 * kMs) {
  PriorHistory history;
  for (std::int64_t t = kMs; t <= 1001 * kMs; t += step_ns) {
    Prior prior;
    prior.stamp_ns = t;
    prior.w_base_rad_s = w_base_rad_s;
    prior.attitude_valid = true;
    history.add(prior);
  }
  return history;
}

}  // namespace

TEST_CASE("a constant rate turns by rate times time, between stamps that are no priors'") {
  const Eigen::Vector3d w(0.3, -0.2, 1.1);
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  REQUIRE(gyro_turn(turning(w), 103 * kMs, 907 * kMs, turn));
  CHECK((log_so3(turn) - 0.804 * w).norm() < 1e-12);
  REQUIRE(gyro_turn(turning(w), 102 * kMs, 104 * kMs, turn));
  CHECK((log_so3(turn) - 0.002 * w).norm() < 1e-12);
}

TEST_CASE("a time that the priors do not cover, or with a gap, is no turn") {
  const PriorHistory history = turning({0.0, 0.0, 1.0});
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  CHECK_FALSE(gyro_turn(history, 0, 100 * kMs, turn));
  CHECK_FALSE(gyro_turn(history, 900 * kMs, 1002 * kMs, turn));
  CHECK_FALSE(gyro_turn(history, 500 * kMs, 400 * kMs, turn));
  CHECK_FALSE(gyro_turn(turning({0.0, 0.0, 1.0}, 125 * kMs), 200 * kMs, 400 * kMs, turn));
  CHECK_FALSE(gyro_turn(PriorHistory(2), 200 * kMs, 400 * kMs, turn));
  CHECK(turn.isApprox(Eigen::Quaterniond::Identity()));
}

}  // namespace isobar::test::test_gyro_turn
