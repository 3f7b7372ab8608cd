// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/registration/unseen_motion.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_unseen_motion {
namespace {

constexpr std::int64_t kKilledNs = 1'700'000'000'000'000'000;
constexpr std::int64_t kStepNs = 10'000'000;
constexpr double kSpeedMS = 0.7;
constexpr double kRateRadS = 0.4;

/// Place of a robot that drives a circle of kSpeedMS / kRateRadS to the left, at yaw 0 in its origin.
KnownPlace on_circle() {
  KnownPlace place;
  place.stamp_ns = kKilledNs;
  place.v_map_m_s = {kSpeedMS, 0.0, 0.0};
  place.yaw_rate_rad_s = kRateRadS;
  return place;
}

Eigen::Vector2d circle_at(double seconds) {
  const double angle = kRateRadS * seconds;
  return kSpeedMS / kRateRadS * Eigen::Vector2d(std::sin(angle), 1.0 - std::cos(angle));
}

/// Priors from `first_s` to `last_s` after the kill of a robot that goes on as it did.
PriorHistory priors(double first_s, double last_s, bool wheels, double speed_m_s = kSpeedMS,
                    double rate_rad_s = kRateRadS) {
  PriorHistory history;
  for (auto t = kKilledNs + static_cast<std::int64_t>(first_s * 1e9);
       t <= kKilledNs + static_cast<std::int64_t>(last_s * 1e9); t += kStepNs) {
    Prior prior;
    prior.stamp_ns = t;
    prior.attitude_valid = true;
    prior.w_base_rad_s = {0.0, 0.0, rate_rad_s};
    prior.velocity_valid = wheels;
    if (wheels) prior.v_base_m_s = {speed_m_s, 0.0, 0.0};
    history.add(prior);
  }
  return history;
}

double yaw_of(const Eigen::Isometry3d& T) { return std::atan2(T.linear()(1, 0), T.linear()(0, 0)); }

}  // namespace

TEST_CASE("a robot on wheels that was killed on a curve is expected further on the curve") {
  const ExpectedPlace expected = expected_place(on_circle(), priors(0.8, 2.0, true));
  // The midpoint rule over 0.8 s at 0.4 rad/s: the chord is shorter than the arc by 0.4 %, 3 mm.
  CHECK((expected.T_map_base.translation().head<2>() - circle_at(2.0)).norm() < 0.005);
  CHECK(std::abs(yaw_of(expected.T_map_base) - 2.0 * kRateRadS) < 0.01);
  CHECK(std::abs(expected.unseen_m - 0.8 * kSpeedMS) < 0.01);
  CHECK_FALSE(expected.stood);
}

TEST_CASE("a robot that brakes while nobody looks is expected at the way of an even deceleration") {
  KnownPlace place = on_circle();
  place.yaw_rate_rad_s = 0.0;
  place.v_map_m_s.x() = 3.0;
  const ExpectedPlace expected = expected_place(place, priors(1.0, 2.0, true, 1.0, 0.0));
  // 2 m/s on average for a second, then 1 m/s for another.
  CHECK(std::abs(expected.T_map_base.translation().x() - 3.0) < 0.02);
}

TEST_CASE("a robot without wheels keeps its velocity while it turns") {
  const ExpectedPlace expected = expected_place(on_circle(), priors(0.8, 2.0, false));
  CHECK((expected.T_map_base.translation() - Eigen::Vector3d(2.0 * kSpeedMS, 0.0, 0.0)).norm() < 0.02);
  CHECK(std::abs(yaw_of(expected.T_map_base) - 2.0 * kRateRadS) < 0.01);
}

TEST_CASE("after a night the robot is where it was, but for what wheels and gyro have seen since") {
  KnownPlace place = on_circle();
  place.stamp_ns -= 30'000'000'000'000;
  const ExpectedPlace still = expected_place(place, priors(0.0, 1.0, true, 0.0, 0.0));
  CHECK(still.T_map_base.isApprox(place.T_map_base, 1e-9));
  CHECK(still.unseen_m == 0.0);
  CHECK_FALSE(still.stood);  // somebody may have carried it away
  const ExpectedPlace moving = expected_place(place, priors(0.0, 1.0, true));
  CHECK((moving.T_map_base.translation().head<2>() - circle_at(1.0)).norm() < 0.005);
}

TEST_CASE("a robot stood if it has wheels, did not move, and the pause was short") {
  KnownPlace place = on_circle();
  place.v_map_m_s = {0.0, 0.0, -1.0};  // an elevator
  place.yaw_rate_rad_s = 0.0;
  CHECK(expected_place(place, priors(0.8, 2.0, true, 0.0, 0.0)).stood);
  CHECK_FALSE(expected_place(place, priors(0.8, 2.0, false, 0.0, 0.0)).stood);
  place.v_map_m_s.x() = 0.5;
  CHECK_FALSE(expected_place(place, priors(0.8, 2.0, true, 0.0, 0.0)).stood);
}

}  // namespace isobar::test::test_unseen_motion
