// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_barometer_drift {

namespace {

constexpr double kStartS = 60.0;

double drifted_pa(double pa_s, double t) { return pa_s * std::max(0.0, t - kStartS); }

PriorCounters counters_of(SimulatedRobot robot, double duration_s, unsigned seed) {
  robot.duration_s = duration_s;
  PriorCounters counters;
  run(robot, config_for(robot), seed, &counters, 100);
  return counters;
}

}  // namespace

TEST_CASE("before any lidar a robot that stands knows which barometer drifts") {
  SimulatedRobot standing;
  standing.motion = Drive{.start_s = 1e9};
  for (const double pa_s : {0.05, -0.25}) {
    CAPTURE(pa_s);
    SimulatedRobot robot = standing;
    robot.extra_robot_pa = [=](double t) { return drifted_pa(pa_s, t); };
    const PriorCounters of_robot = counters_of(robot, kStartS + 60.0, 3);
    CHECK(of_robot.robot_faults == 1);
    CHECK(of_robot.base_faults == 0);
    SimulatedRobot base = standing;
    base.common_pa = [=](double t) { return drifted_pa(pa_s, t); };
    base.extra_robot_pa = [=](double t) { return -drifted_pa(pa_s, t); };
    const PriorCounters of_base = counters_of(base, kStartS + 60.0, 3);
    CHECK(of_base.robot_faults == 0);
    CHECK(of_base.base_faults == 1);
  }
}

TEST_CASE("weather, warm-up, a ride and a drive are no drift of a barometer") {
  SimulatedRobot robot;
  robot.motion = Drive{.start_s = 100.0, .stop_s = 130.0, .radius_m = 4.0, .lift = [](double t) {
                         return travelled(t, 1.0, 40.0, 50.0, 2.0);
                       }};
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const PriorCounters counters = counters_of(robot, 200.0, seed);
    CHECK(counters.robot_faults == 0);
    CHECK(counters.base_faults == 0);
  }
}

}  // namespace isobar::test::test_barometer_drift
