// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/prior/attitude_filter.hpp"
#include "core/so3.hpp"
#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_attitude {

namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;

SensorErrors no_errors() {
  SensorErrors e;
  e.gyro_noise = e.accel_noise = e.gyro_bias = e.accel_bias = e.vibration = e.misalignment = 0.0;
  e.wheel_scale = e.wheel_noise = e.stairs_slip = e.pressure_noise = e.turbulence = e.warm_up = 0.0;
  e.weather_pa_s = e.self_heating_k = 0.0;
  return e;
}

/// Without the unobservable errors: tilt of the mount and accelerometer bias.
SensorErrors without_tilt() {
  SensorErrors e;
  e.misalignment = e.accel_bias = 0.0;
  return e;
}

SimulatedRobot stairs_robot() {
  SimulatedRobot robot;
  Drive drive;
  drive.speed = 0.5;
  drive.radius_m = 12.0;
  drive.height = [](double s) { return -travelled(s, 0.577, 8.0, 14.0, 1.0); };  // 30 deg down
  robot.motion = drive;
  robot.duration_s = 60.0;
  return robot;
}

}  // namespace

TEST_CASE("with perfect sensors roll and pitch are exact under acceleration, turns and stairs") {
  SimulatedRobot robot = stairs_robot();
  robot.errors = no_errors();
  const auto comparisons = run(robot, config_for(robot), 1);
  // 0.02 deg: wheel speeds are used up to one wheel period (20 ms) late.
  CHECK(figures_of(comparisons).roll_pitch_rms_rad < 0.02 * kDeg);
}

TEST_CASE("roll and pitch of a shaking tracked robot are good to 0.2 deg, on stairs too") {
  SimulatedRobot robot = stairs_robot();
  robot.errors = without_tilt();
  double sum = 0.0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Figures figures = figures_of(run(robot, config_for(robot), seed, nullptr, 4));
    CHECK(figures.roll_pitch_rms_rad < 0.2 * kDeg);
    sum += figures.roll_pitch_rms_rad;
  }
  CHECK(sum / 3.0 < 0.15 * kDeg);
}

TEST_CASE("roll and pitch are as accurate with IMU rates of 50 and 800 Hz and a rotated, off-centre IMU") {
  for (const double hz : {50.0, 800.0}) {
    SimulatedRobot robot = stairs_robot();
    robot.errors = without_tilt();
    robot.imu_hz = hz;
    robot.duration_s = 40.0;
    robot.T_base_imu = Eigen::Translation3d(0.3, -0.2, 0.5) *
                       Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, 2.0, 0.5).normalized());
    CHECK(figures_of(run(robot, config_for(robot), 4, nullptr, 4)).roll_pitch_rms_rad < 0.25 * kDeg);
  }
}

TEST_CASE("a pendulum without wheels keeps its attitude") {
  SimulatedRobot robot;
  robot.wheel_hz = 0.0;
  robot.errors = without_tilt();
  robot.duration_s = 90.0;
  robot.motion = [](double t) {
    const double length = 20.0;
    const double angle = 0.02 * std::sin(std::sqrt(kGravity / length) * t);
    Pose pose;
    pose.p = {length * std::sin(angle), 0.0,
              length * (1.0 - std::cos(angle)) - travelled(t, 0.3, 5.0, 80.0, 3.0)};
    pose.q = Eigen::AngleAxisd(0.3 * std::sin(0.2 * t), Eigen::Vector3d::UnitZ()) *
             Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY());
    return pose;
  };
  const auto comparisons = run(robot, config_for(robot), 2, nullptr, 4);
  // From the 30th second on: the gyro bias is only observable through gravity.
  CHECK(figures_of(comparisons, 30.0).roll_pitch_rms_rad < 0.2 * kDeg);
  CHECK_FALSE(comparisons.back().prior.velocity_valid);
  CHECK_FALSE(comparisons.back().prior.standing_still);
  CHECK(comparisons.back().prior.T_odom_base.translation().norm() == 0.0);
}

TEST_CASE("the gyro bias is estimated at standstill: yaw of a standing robot does not drift") {
  SimulatedRobot robot;
  robot.errors.gyro_bias = 0.0087;  // 0.5 deg/s
  robot.motion = [](double) { return Pose{}; };
  robot.duration_s = 30.0;
  const auto comparisons = run(robot, config_for(robot), 3);
  CHECK(comparisons.back().prior.standing_still);
  const auto yaw = [&](double t) {
    return yaw_of(
        Eigen::Quaterniond(comparisons[static_cast<std::size_t>(t * 200.0)].prior.T_odom_base.linear()));
  };
  // Angle random walk of 0.3 deg/sqrt(min), over 20 s: 0.17 deg. An uncorrected bias would give 10 deg.
  CHECK(std::abs(yaw(29.9) - yaw(9.9)) < 0.3 * kDeg);
}

TEST_CASE("yaw is the integral of the corrected gyro: a bias found at a late standstill causes no jump") {
  SimulatedRobot robot;
  robot.errors.gyro_bias = 0.0087;  // 0.5 deg/s, unknown: the robot drives from the start
  Drive drive;
  drive.start_s = -20.0;
  drive.radius_m = 5.0;
  drive.stop_s = 60.0;
  robot.motion = drive;
  robot.duration_s = 70.0;
  const auto comparisons = run(robot, config_for(robot), 3);
  CHECK(comparisons.back().prior.standing_still);
  double largest_rad = 0.0;
  for (std::size_t i = 200; i < comparisons.size(); ++i) {
    const Eigen::Quaterniond before(comparisons[i - 1].prior.T_odom_base.linear());
    const Eigen::Quaterniond now(comparisons[i].prior.T_odom_base.linear());
    const double turned = log_so3(now * before.conjugate()).z();
    const double measured = (now * comparisons[i].prior.w_base_rad_s).z() / 200.0;
    largest_rad = std::max(largest_rad, std::abs(turned - measured));
  }
  // Corrections of roll and pitch turn the axes by some hundredths of a degree, and tilt couples a part of
  // that into yaw.
  CHECK(largest_rad < 0.005 * kDeg);
}

TEST_CASE("a start while driving reaches the same accuracy") {
  SimulatedRobot robot;
  Drive drive;
  drive.start_s = -20.0;
  drive.radius_m = 4.0;
  robot.motion = drive;
  robot.errors = without_tilt();
  robot.duration_s = 60.0;
  CHECK(figures_of(run(robot, config_for(robot), 6, nullptr, 4), 30.0).roll_pitch_rms_rad < 0.2 * kDeg);
}

TEST_CASE("the IMU's own attitude, where configured, replaces the accelerometer") {
  AttitudeConfig config;
  config.use_imu_attitude = true;
  PriorConfig prior_config;
  prior_config.attitude = config;
  PriorEstimator estimator(prior_config);
  Prior prior;
  const Eigen::Quaterniond truth(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()));
  for (int i = 0; i < 200 * 120; ++i) {
    ImuSample sample;
    sample.stamp_ns = i * 5'000'000LL;
    // The accelerometer is off by 0.3 m/s^2, which alone would tilt by 1.75 deg.
    sample.accel_m_s2 = truth.conjugate() * Eigen::Vector3d(0.3, 0.0, kGravity);
    sample.q_world_imu = truth;
    sample.has_attitude = true;
    estimator.add_imu(sample, prior);
  }
  CHECK(std::abs(roll_of(prior.T_odom_base.linear()) - 0.05) < 0.003);
  CHECK(std::abs(pitch_of(prior.T_odom_base.linear())) < 0.6 * kDeg);
}

TEST_CASE("the error of pitch stays within three sigmas of the filter") {
  AttitudeConfig config;
  AttitudeFilter filter(config, Eigen::Vector3d::Zero());
  filter.start(Eigen::Vector3d(0.1, 0.0, kGravity), 0.7, 0.02);
  CHECK(yaw_of(filter.q_world_base()) == doctest::Approx(0.7).epsilon(1e-6));
  CHECK(pitch_of(filter.q_world_base().toRotationMatrix()) ==
        doctest::Approx(-0.0102).epsilon(0.01).scale(0.0));
  const double before = filter.roll_pitch_variance_rad2();
  for (int i = 0; i < 2000; ++i) {
    filter.predict(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, kGravity), 0.005, 1e-6, 1e-4);
    if (i % 4 == 0) filter.update_wheels(WheelSample{}, 0.02, true);
  }
  CHECK(filter.roll_pitch_variance_rad2() < before);
  const double error = std::abs(pitch_of(filter.q_world_base().toRotationMatrix()));
  CHECK(error < 3.0 * std::sqrt(filter.roll_pitch_variance_rad2()));
}

}  // namespace isobar::test::test_attitude
