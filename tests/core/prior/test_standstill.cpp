// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <random>

#include "core/prior/standstill.hpp"

namespace isobar::test::test_standstill {

namespace {

struct Shaker {
  std::mt19937 random{9};
  std::normal_distribution<double> normal{0.0, 1.0};
  void feed(StandstillDetector& detector, double seconds, double gyro_mean, double gyro_rms,
            double accel_rms) {
    for (double t = 0.0; t < seconds; t += 0.005) {
      const Eigen::Vector3d gyro = Eigen::Vector3d::Constant(gyro_mean) + gyro_rms * vector();
      detector.add_imu(gyro, Eigen::Vector3d::Zero(), 0.001,
                       Eigen::Vector3d(0.0, 0.0, 9.8) + accel_rms * vector(), 0.005);
    }
  }
  Eigen::Vector3d vector() {
    const double x = normal(random);
    const double y = normal(random);
    return {x, y, normal(random)};
  }
};

}  // namespace

TEST_CASE("quiet sensors are a standstill, and the mean rate of a window is returned once") {
  StandstillDetector detector{StandstillConfig{}};
  Shaker shaker;
  CHECK_FALSE(detector.standing());
  shaker.feed(detector, 0.7, 0.003, 0.005, 0.02);
  CHECK(detector.standing());
  CHECK(detector.take_window());
  CHECK_FALSE(detector.take_window());
  CHECK(detector.mean_gyro_rad_s().x() == doctest::Approx(0.003).epsilon(0.5).scale(0.0));
  CHECK(detector.window_s() >= 0.6);
}

TEST_CASE("vibration, turning or rolling is no standstill") {
  Shaker shaker;
  StandstillDetector vibrating{StandstillConfig{}};
  shaker.feed(vibrating, 2.0, 0.0, 0.005, 2.5);
  CHECK_FALSE(vibrating.standing());
  StandstillDetector turning{StandstillConfig{}};
  shaker.feed(turning, 2.0, 0.2, 0.005, 0.02);
  CHECK_FALSE(turning.standing());
  StandstillDetector rolling{StandstillConfig{}};
  shaker.feed(rolling, 0.7, 0.0, 0.005, 0.02);
  CHECK(rolling.standing());
  rolling.add_wheel(0.3, 0.0);
  CHECK_FALSE(rolling.standing());
}

TEST_CASE("one turning sample ends a standstill at once") {
  Shaker shaker;
  StandstillDetector detector{StandstillConfig{}};
  shaker.feed(detector, 0.7, 0.0, 0.005, 0.02);
  REQUIRE(detector.standing());
  shaker.feed(detector, 0.005, 1.0, 0.0, 0.0);
  CHECK_FALSE(detector.standing());
}

}  // namespace isobar::test::test_standstill
