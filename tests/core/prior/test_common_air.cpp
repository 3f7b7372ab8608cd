// SPDX-License-Identifier: BSD-3-Clause
// Changes of the pressure that robot and base station share: weather fronts, gusts over the site.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_common_air {

namespace {

SimulatedRobot standing_robot() {
  SimulatedRobot robot;
  robot.imu_hz = 100.0;  // half the work
  Drive drive;
  drive.stop_s = 4.0;
  robot.motion = drive;
  robot.duration_s = 70.0;
  return robot;
}

/// Up by 1.2 m/s for 12 s: 14 Pa/s.
SimulatedRobot lift_robot() {
  SimulatedRobot robot = standing_robot();
  Drive drive;
  drive.stop_s = 4.0;
  drive.lift = [](double t) { return travelled(t, 1.2, 20.0, 32.0, 1.2); };
  robot.motion = drive;
  return robot;
}

struct Effect {
  double added_m = 0.0;  ///< largest height error beyond that of the same robot in still air
  std::uint64_t base_faults = 0;
};

Effect effect_of(SimulatedRobot robot, double base_hz, double base_delay_s,
                 const std::function<double(double)>& common_pa) {
  robot.base_hz = base_hz;
  robot.base_delay_s = base_delay_s;
  const PriorConfig config = config_for(robot);
  const auto still = run(robot, config, 11, nullptr, 4);
  robot.common_pa = common_pa;
  PriorCounters counters;
  const auto moving = run(robot, config, 11, &counters, 4);
  REQUIRE(still.size() == moving.size());
  Effect effect;
  effect.base_faults = counters.base_faults;
  for (std::size_t i = 0; i < still.size(); ++i) {
    effect.added_m = std::max(effect.added_m, std::abs(moving[i].prior.height_m - still[i].prior.height_m));
  }
  return effect;
}

double ramp_pa(double t) { return std::clamp(t - 15.0, 0.0, 40.0); }
double gusts_pa(double t) { return t > 15.0 ? 3.0 * std::sin(2.0 * M_PI * 0.2 * (t - 15.0)) : 0.0; }
double storm_pa(double t) { return 2.0 * ramp_pa(t) + 2.0 * gusts_pa(t); }

}  // namespace

TEST_CASE(
    "ramps and gusts at both barometers move the height by less than 3 cm, at any rate of the base station") {
  for (const double base_hz : {1.0, 4.0, 32.0}) {
    for (const double delay_s : {0.0, 0.4}) {
      for (const auto& common : {ramp_pa, gusts_pa, storm_pa}) {
        for (const SimulatedRobot& robot : {standing_robot(), lift_robot()}) {
          CAPTURE(base_hz);
          CAPTURE(delay_s);
          CAPTURE(common(17.3));
          const Effect effect = effect_of(robot, base_hz, delay_s, common);
          CHECK(effect.added_m < 0.03);
          CHECK(effect.base_faults == 0);
        }
      }
    }
  }
}

TEST_CASE("a slow and late base station does not delay the robot's height in an elevator") {
  SimulatedRobot robot = lift_robot();
  const auto largest_m = [&](double base_hz, double delay_s) {
    robot.base_hz = base_hz;
    robot.base_delay_s = delay_s;
    return figures_of(run(robot, config_for(robot), 11, nullptr, 4)).height_max_m;
  };
  const double fast_m = largest_m(32.0, 0.0);
  // Readings of one second's delay at 1.2 m/s would err by 1.2 m. One reading a second has 4 cm of noise.
  CHECK(largest_m(1.0, 0.7) < fast_m + 0.12);
}

}  // namespace isobar::test::test_common_air
