// SPDX-License-Identifier: BSD-3-Clause
// Weight of wheel samples whose sender states their noise.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/prior/attitude_filter.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/prior/prior_pace.hpp"
#include "core/prior/wheel_noise.hpp"

namespace isobar::test::test_wheel_noise {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

WheelSample sample_with(double vx_variance, double vy_variance, double wz_variance) {
  WheelSample sample;
  sample.vx_variance_m2_s2 = vx_variance;
  sample.vy_variance_m2_s2 = vy_variance;
  sample.wz_variance_rad2_s2 = wz_variance;
  return sample;
}

/// Speed that a filter at rest believes after one sample of a small speed [m/s].
double believed_speed(double sigma_m_s) {
  AttitudeFilter filter(AttitudeConfig{}, Eigen::Vector3d::Zero());
  filter.start(Eigen::Vector3d(0.0, 0.0, kGravity), 0.0, 0.02);
  filter.predict(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, kGravity), 0.005, 1e-6, 1e-4);
  WheelSample sample = sample_with(sigma_m_s * sigma_m_s, kUnknown, kUnknown);
  sample.vx_m_s = 0.01;
  filter.update_wheels(sample, 0.02, true);
  return filter.velocity_m_s().x();
}

/// The last prior of a robot that drives a slow arc for two seconds, with these variances in its wheel samples.
Prior drive(const WheelSample& variances, PriorCounters& counters, bool has_imu = true) {
  PriorConfig config;
  config.has_imu = has_imu;
  PriorEstimator estimator(config);
  PriorPace pace;
  Prior prior;
  for (int i = 0; i <= 400; ++i) {
    const std::int64_t stamp_ns = kStart + i * std::int64_t{5'000'000};
    WheelSample wheels = variances;
    wheels.stamp_ns = stamp_ns;
    wheels.vx_m_s = i < 200 ? 0.0 : 0.3;
    wheels.wz_rad_s = i < 200 ? 0.0 : 0.2;
    if (i % 4 == 0) estimator.add_wheel(wheels);
    ImuSample imu;
    imu.stamp_ns = stamp_ns;
    imu.gyro_rad_s = {1e-3 * std::sin(12.9 * i), 1e-3 * std::sin(7.1 * i), wheels.wz_rad_s};
    imu.accel_m_s2 = {0.02 * std::sin(3.3 * i), 0.02 * std::sin(5.7 * i), kGravity};
    if (has_imu) {
      estimator.add_imu(imu, prior);
    } else {
      for (std::int64_t step_ns = 0; pace.next(stamp_ns, step_ns);) estimator.advance(step_ns, prior);
    }
  }
  counters = estimator.counters();
  return prior;
}

void check_same_bits(const Prior& a, const Prior& b) {
  CHECK(a.T_odom_base.matrix() == b.T_odom_base.matrix());
  CHECK(a.roll_pitch_variance_rad2 == b.roll_pitch_variance_rad2);
  CHECK(a.velocity_variance_m2_s2 == b.velocity_variance_m2_s2);
  CHECK(a.yaw_rate_variance_rad2_s2 == b.yaw_rate_variance_rad2_s2);
}

}  // namespace

TEST_CASE("a wheel sample with a standard deviation twice as large weighs a quarter in the attitude filter") {
  // As far as the sample's variance, 50 and 200 (m/s)^2 with its correlation over 25 samples, outweighs the filter's
  // own, which is far below 1 (m/s)^2.
  CHECK(believed_speed(1.0) / believed_speed(2.0) == doctest::Approx(4.0).epsilon(0.02));
  CHECK(believed_speed(1.0) > 0.0);
}

TEST_CASE("a standard deviation twice as large is twice as large in the prior of a robot that stands") {
  for (const double sigma_m_s : {0.05, 0.2}) {
    double variances[2] = {};  // NOLINT(modernize-avoid-c-arrays)
    for (int twice = 0; twice < 2; ++twice) {
      const double sigma = sigma_m_s * (1 + twice);
      PriorConfig config;
      config.attitude.wheel_sigma_share = 0.0;
      PriorEstimator robot(config);
      Prior prior;
      for (int i = 0; i < 300; ++i) {
        WheelSample wheels = sample_with(sigma * sigma, kUnknown, kUnknown);
        ImuSample imu;
        imu.stamp_ns = wheels.stamp_ns = kStart + i * std::int64_t{5'000'000};
        imu.accel_m_s2.z() = kGravity;
        robot.add_wheel(wheels);
        robot.add_imu(imu, prior);
      }
      REQUIRE(prior.velocity_valid);
      variances[twice] = prior.velocity_variance_m2_s2;
    }
    CHECK(variances[0] == doctest::Approx(sigma_m_s * sigma_m_s));
    CHECK(variances[1] / variances[0] == doctest::Approx(4.0));
  }
}

TEST_CASE("what a differential drive states of its sideways speed replaces the configured slip") {
  PriorCounters counters;
  const Prior tight = drive(sample_with(1e-3, 1e-3, kUnknown), counters);
  const Prior loose = drive(sample_with(1e-3, 4.0, kUnknown), counters);
  // The sideways constraint is what keeps roll: without it roll is known from the specific force alone.
  CHECK(loose.roll_pitch_variance_rad2 > tight.roll_pitch_variance_rad2);
  CHECK(counters.wheel_bad_variance == 0);
}

TEST_CASE("without an IMU the turn rate has the stated variance, on top of the share that slips") {
  PriorCounters counters;
  const Prior once = drive(sample_with(kUnknown, kUnknown, 0.01), counters, false);
  const Prior twice = drive(sample_with(kUnknown, kUnknown, 0.04), counters, false);
  const auto noise = [](const Prior& p) { return p.yaw_rate_variance_rad2_s2 - p.yaw_bias_variance_rad2_s2; };
  CHECK(noise(once) == doctest::Approx(0.01));
  CHECK(noise(twice) / noise(once) == doctest::Approx(4.0));
}

TEST_CASE("variances that nobody can mean are counted, and the configured noise is used to the bit") {
  PriorCounters counters;
  const Prior configured = drive(WheelSample{}, counters);
  CHECK(counters.wheel_bad_variance == 0);
  const std::uint64_t samples = counters.wheel_accepted;
  const double kInfinite = std::numeric_limits<double>::infinity();
  for (const double absurd : {0.0, -1.0, -0.01, 1e-9, 9e-5, 11.0, 1e6, kInfinite, -kInfinite}) {
    CAPTURE(absurd);
    check_same_bits(drive(sample_with(absurd, absurd, absurd), counters), configured);
    CHECK(counters.wheel_bad_variance == samples);
    // One that is stated well beside it is believed all the same.
    const Prior half = drive(sample_with(0.25, absurd, absurd), counters);
    CHECK(half.velocity_variance_m2_s2 > 0.25);
    CHECK(counters.wheel_bad_variance == (absurd >= 1e-6 && absurd <= 10.0 ? 0 : samples));
  }
  // A differential drive states anything for the speed that it does not measure.
  check_same_bits(drive(sample_with(kUnknown, 1e6, kUnknown), counters), configured);
  CHECK(counters.wheel_bad_variance == 0);
}

}  // namespace isobar::test::test_wheel_noise
