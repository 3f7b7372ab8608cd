// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/prior/slip_watch.hpp"
#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_slip_watch {

namespace {

/// Seconds of turn slip in a time with rates given as functions of time.
template <class Gyro, class Wheels>
int turn_slips(double seconds, const Gyro& gyro, const Wheels& wheels) {
  SlipWatch watch;
  int slips = 0;
  constexpr double kDtS = 0.005;
  const auto samples = static_cast<int>(std::lround(seconds / kDtS));
  for (int i = 0; i < samples; ++i) {
    watch.add_rates(gyro(i * kDtS), wheels(i * kDtS), kDtS);
    slips += watch.take().turn ? 1 : 0;
  }
  return slips;
}

auto constant(double rate_rad_s) {
  return [rate_rad_s](double) { return rate_rad_s; };
}

/// Estimator of a robot that drives straight, whose wheels the test makes up.
struct Straight {
  PriorEstimator estimator{PriorConfig{}};
  std::int64_t stamp_ns = 1'700'000'000'000'000'000;
  void drive(double seconds, double gyro_z_rad_s, double vx_m_s, double wz_rad_s) {
    const auto samples = static_cast<int>(std::lround(seconds * 200.0));
    for (int i = 0; i < samples; ++i, stamp_ns += 5'000'000) {
      if (i % 4 == 0) estimator.add_wheel({.stamp_ns = stamp_ns, .vx_m_s = vx_m_s, .wz_rad_s = wz_rad_s});
      ImuSample imu;
      imu.stamp_ns = stamp_ns;
      imu.gyro_rad_s = {1e-4 * (i % 3), 0.0, gyro_z_rad_s};
      imu.accel_m_s2 = {0.0, 0.01 * (i % 2), kGravity};
      Prior prior;
      (void)estimator.add_imu(imu, prior);
    }
  }
};

}  // namespace

TEST_CASE(
    "wheels that turn as the gyro does slip not, nor with a track width that is wrong by a factor of 2") {
  CHECK(turn_slips(20.0, constant(0.8), constant(0.8)) == 0);
  CHECK(turn_slips(20.0, constant(0.5), constant(1.0)) == 0);
  CHECK(turn_slips(20.0, constant(-1.0), constant(-0.5)) == 0);
  CHECK(turn_slips(20.0, constant(0.009), constant(0.0)) == 0);  // a bias
}

TEST_CASE("wheels heard 0.1 s late slip not while the turn changes its direction every second") {
  const auto gyro = [](double t) { return 1.5 * std::cos(M_PI * t); };
  CHECK(turn_slips(60.0, gyro, [&](double t) { return gyro(t - 0.1); }) == 0);
}

TEST_CASE("a wheel that spins is slip in every second that it lasts") {
  CHECK(turn_slips(10.0, constant(0.0), constant(0.2)) == 10);
  // Wheels that stand while the robot is turned, and wheels that turn it the other way.
  CHECK(turn_slips(10.0, constant(0.5), constant(0.0)) == 10);
  CHECK(turn_slips(10.0, constant(0.3), constant(-0.3)) == 10);
}

TEST_CASE("noise of gyro and wheels is no slip") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  CHECK(turn_slips(
            300.0, [&](double) { return 0.1 * normal(random); },
            [&](double) { return 0.05 * normal(random); }) == 0);
}

TEST_CASE("speeds refused for most of a second are slip of the speed") {
  for (const bool used : {true, false}) {
    SlipWatch watch;
    SlipWatch::Slip found;
    for (int i = 0; i < 201; ++i) {
      if (i % 4 == 0) watch.add_speed(used || i < 40, 0.02);
      watch.add_rates(0.0, 0.0, 0.005);
      const SlipWatch::Slip slip = watch.take();
      found.speed = found.speed || slip.speed;
      found.turn = found.turn || slip.turn;
    }
    CHECK(found.speed == !used);
    CHECK_FALSE(found.turn);
  }
}

TEST_CASE(
    "the estimator counts a wheel that spins, and robots that drive on stairs and in circles slip not") {
  Straight robot;
  robot.drive(5.0, 0.0, 0.5, 0.0);
  CHECK(robot.estimator.counters().wheel_turn_slips == 0);
  robot.drive(3.0, 0.0, 0.5, 0.6);
  CHECK(robot.estimator.counters().wheel_turn_slips >= 2);
  CHECK(robot.estimator.counters().wheel_turn_slips <= 4);

  for (const double radius_m : {3.0, -20.0}) {
    SimulatedRobot driving;
    Drive drive;
    drive.radius_m = radius_m;
    drive.height = [](double s) { return -travelled(s, 0.577, 6.0, 12.0, 1.0); };
    driving.motion = drive;
    PriorCounters counters;
    (void)run(driving, config_for(driving), 4, &counters);
    CHECK(counters.wheel_accepted > 2'000);
    CHECK(counters.wheel_turn_slips == 0);
    CHECK(counters.wheel_speed_slips == 0);
  }
}

TEST_CASE("wheels that block at 2 m/s while the accelerometer feels no braking are slip of the speed") {
  Straight robot;
  robot.drive(10.0, 0.0, 2.0, 0.0);
  CHECK(robot.estimator.counters().wheel_speed_slips == 0);
  robot.drive(2.0, 0.0, 0.0, 0.0);
  CHECK(robot.estimator.counters().wheel_speed_slips >= 1);
  CHECK(robot.estimator.counters().wheel_turn_slips == 0);
}

}  // namespace isobar::test::test_slip_watch
