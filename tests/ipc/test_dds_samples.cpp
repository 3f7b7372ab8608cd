// SPDX-License-Identifier: BSD-3-Clause
// Conversion between ROS 2 messages and samples, without a network.
#include "ipc/dds/samples.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

namespace isobar::test::test_dds_samples {

using namespace isobar::dds;

namespace {

TEST_CASE(
    "a base station's sample survives the conversion to two messages and back; an unknown variance stays "
    "unknown") {
  const std::string frame = "roof";
  PressureSample sent{7'000'000'123, 98'765.4321, 18.5};
  const auto back = [&] {
    PressureMessage pressure{};
    TemperatureMessage temperature{};
    fill_pressure(sent, frame, pressure);
    fill_temperature(sent, frame, temperature);
    CHECK(std::string(pressure.header.frame_id) == "roof");
    CHECK(std::string(temperature.header.frame_id) == "roof");
    PressureSample got;
    TemperatureSample at_it;
    CHECK(to_sample(pressure, got) == nullptr);
    CHECK(to_sample(temperature, at_it) == nullptr);
    CHECK(at_it.stamp_ns == got.stamp_ns);
    got.temperature_c = at_it.temperature_c;
    return got;
  };
  CHECK(back().stamp_ns == sent.stamp_ns);
  CHECK(back().pressure_pa == sent.pressure_pa);
  CHECK(back().temperature_c == sent.temperature_c);
  CHECK(std::isnan(back().variance_pa2));
  sent.variance_pa2 = 0.125;
  CHECK(back().variance_pa2 == 0.125);
  PressureMessage pressure{};
  fill_pressure(sent, frame, pressure);
  for (const double unknown :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    pressure.variance = unknown;
    PressureSample got;
    CHECK(to_sample(pressure, got) == nullptr);
    CHECK(std::isnan(got.variance_pa2));
  }
  TemperatureMessage temperature{};
  for (const double bad : {-273.15, 1e6, std::numeric_limits<double>::quiet_NaN()}) {
    temperature.temperature = bad;
    TemperatureSample got{1, 20.0};
    CHECK(to_sample(temperature, got) != nullptr);
    CHECK(got.temperature_c == 20.0);
  }
}

TEST_CASE("received samples are checked for plausibility; an implausible one leaves the sample unchanged") {
  PressureMessage pressure{};
  pressure.header.stamp = {5, 6};
  pressure.fluid_pressure = 101325.0;
  PressureSample taken;
  CHECK(to_sample(pressure, taken) == nullptr);
  CHECK(taken.stamp_ns == 5'000'000'006);
  CHECK(taken.pressure_pa == 101325.0);
  CHECK(std::isnan(taken.temperature_c));
  for (const double bad :
       {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    pressure.fluid_pressure = bad;
    CHECK(to_sample(pressure, taken) != nullptr);
    CHECK(taken.pressure_pa == 101325.0);
  }
  pressure.fluid_pressure = 101325.0;
  pressure.header.stamp.sec = -1;
  CHECK(to_sample(pressure, taken) != nullptr);

  ImuMessage imu{};
  imu.linear_acceleration.z = 9.8;
  imu.angular_velocity.x = 0.5;
  imu.orientation_covariance[0] = -1.0;
  ImuSample inertial;
  CHECK(to_sample(imu, inertial) == nullptr);
  CHECK_FALSE(inertial.has_attitude);
  CHECK(inertial.gyro_rad_s.x() == 0.5);
  imu.orientation_covariance[0] = 0.01;
  CHECK(to_sample(imu, inertial) != nullptr);  // a zero quaternion is no attitude
  imu.orientation = {0.0, 0.0, 0.0, 1.05};
  CHECK(to_sample(imu, inertial) == nullptr);
  CHECK(inertial.has_attitude);
  CHECK(inertial.q_world_imu.norm() == doctest::Approx(1.0));
  imu.linear_acceleration.x = std::numeric_limits<double>::quiet_NaN();
  CHECK(to_sample(imu, inertial) != nullptr);

  OdometryMessage odometry{};
  odometry.twist.twist.linear.x = 1.5;
  odometry.twist.twist.angular.z = -0.25;
  WheelSample wheel;
  CHECK(to_sample(odometry, wheel) == nullptr);
  CHECK(wheel.vx_m_s == 1.5);
  CHECK(wheel.wz_rad_s == -0.25);
  CHECK(std::isnan(wheel.vx_variance_m2_s2));  // zeros: not stated
  odometry.twist.covariance[0] = 0.04;
  odometry.twist.covariance[7] = 1e6;
  odometry.twist.covariance[35] = std::numeric_limits<double>::quiet_NaN();
  CHECK(to_sample(odometry, wheel) == nullptr);
  CHECK(wheel.vx_variance_m2_s2 == 0.04);
  CHECK(wheel.vy_variance_m2_s2 == 1e6);
  CHECK(std::isinf(wheel.wz_variance_rad2_s2));  // stated, and no number: counted where it is judged
  odometry.twist.covariance[0] = -1.0;
  CHECK(to_sample(odometry, wheel) == nullptr);
  CHECK(std::isnan(wheel.vx_variance_m2_s2));
  CHECK(std::isnan(wheel.vy_variance_m2_s2));
  CHECK(std::isnan(wheel.wz_variance_rad2_s2));
  odometry.twist.twist.linear.y = 1e6;
  CHECK(to_sample(odometry, wheel) != nullptr);
  CHECK(wheel.vy_m_s == 0.0);
}

}  // namespace

}  // namespace isobar::test::test_dds_samples
