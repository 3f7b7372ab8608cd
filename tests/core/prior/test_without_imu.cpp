// SPDX-License-Identifier: BSD-3-Clause
// The prior of a robot without an IMU: the way of the wheels on a plane, the height of the air, rides of elevators.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/prior/air_ride.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/prior/prior_pace.hpp"

namespace isobar::test::test_without_imu {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr double kStepS = 0.02;

std::int64_t at(double t) { return kStart + static_cast<std::int64_t>(std::llround(t * 1e9)); }

PriorConfig without_imu() {
  PriorConfig config;
  config.has_imu = false;
  return config;
}

struct Sensors {
  WheelSample wheels;                        ///< constant; none while it is not finite
  std::function<double(double)> height_m{};  ///< of the barometer by time; empty: none
};

/// Pressure at a height, 293 K.
double pressure_pa(double height_m) { return 101'325.0 * std::exp(-height_m / 8580.0); }

/// Noise of 0.2 Pa at most that repeats no value.
double noise_pa(int i) { return 0.2 * std::sin(12.9898 * i); }

/// Runs for `duration_s` at PriorPace; calls `each` with every prior.
void run(const Sensors& sensors, double duration_s, const std::function<void(double, const Prior&)>& each) {
  PriorEstimator estimator(without_imu());
  PriorPace pace;
  Prior prior;
  const int steps = static_cast<int>(std::lround(duration_s / kStepS));
  for (int i = 0; i <= steps; ++i) {
    const double t = i * kStepS;
    if (std::isfinite(sensors.wheels.vx_m_s)) {
      WheelSample sample = sensors.wheels;
      sample.stamp_ns = at(t);
      estimator.add_wheel(sample);
    }
    if (sensors.height_m) {
      estimator.add_base_pressure(
          {.stamp_ns = at(t), .pressure_pa = pressure_pa(0.0) + noise_pa(2 * i), .temperature_c = 20.0});
      estimator.add_pressure({.stamp_ns = at(t),
                              .pressure_pa = pressure_pa(sensors.height_m(t)) + noise_pa(2 * i + 1),
                              .temperature_c = 20.0});
    }
    for (std::int64_t stamp_ns = 0; pace.next(at(t), stamp_ns);) {
      if (estimator.advance(stamp_ns, prior)) each(t, prior);
    }
  }
}

WheelSample rolling(double vx_m_s, double wz_rad_s) { return {.vx_m_s = vx_m_s, .wz_rad_s = wz_rad_s}; }
WheelSample none() { return rolling(std::nan(""), 0.0); }

}  // namespace

TEST_CASE("a prior comes every 20 ms; after a pause the pace begins anew") {
  PriorPace pace;
  std::int64_t stamp_ns = 0;
  CHECK(pace.next(at(0.0), stamp_ns));
  CHECK(stamp_ns == at(0.0));
  CHECK_FALSE(pace.next(at(0.019), stamp_ns));
  CHECK(pace.next(at(0.045), stamp_ns));
  CHECK(stamp_ns == at(0.02));
  CHECK(pace.next(at(0.045), stamp_ns));
  CHECK(stamp_ns == at(0.04));
  CHECK_FALSE(pace.next(at(0.045), stamp_ns));
  CHECK(pace.next(at(100.0), stamp_ns));
  CHECK(stamp_ns == at(100.0));
  CHECK_FALSE(pace.next(at(100.01), stamp_ns));
}

TEST_CASE("a clock that begins at 0, as in a recording of scans without dates, gives the same pace") {
  PriorPace pace;
  std::int64_t stamp_ns = -1;
  CHECK(pace.next(0, stamp_ns));
  CHECK(stamp_ns == 0);
  CHECK_FALSE(pace.next(0, stamp_ns));
  CHECK(pace.next(30'000'000, stamp_ns));
  CHECK(stamp_ns == 20'000'000);
}

TEST_CASE("wheels give the way on a plane: a circle closes, gravity stays unknown") {
  const double rate_rad_s = 0.5;
  Prior last;
  run({.wheels = rolling(1.0, rate_rad_s)}, 10.0, [&](double t, const Prior& prior) {
    CHECK(prior.velocity_valid);
    CHECK_FALSE(prior.attitude_valid);
    // A circle of 2 m about (0, 2).
    const Eigen::Vector3d truth(2.0 * std::sin(rate_rad_s * t), 2.0 * (1.0 - std::cos(rate_rad_s * t)), 0.0);
    CHECK((prior.T_odom_base.translation() - truth).norm() < 0.01);
    CHECK(std::abs(prior.T_odom_base.linear()(1, 0) - std::sin(rate_rad_s * t)) < 1e-6);
    last = prior;
  });
  CHECK(last.w_base_rad_s.z() == rate_rad_s);
  CHECK(std::sqrt(last.yaw_rate_variance_rad2_s2) > 0.02);
  CHECK(last.height_source == HeightSource::kNone);
}

TEST_CASE("without wheels the robot stands in odom, and says that it does not know") {
  run({.wheels = none()}, 1.0, [](double, const Prior& prior) {
    CHECK_FALSE(prior.velocity_valid);
    CHECK(prior.T_odom_base.matrix().isIdentity());
  });
}

TEST_CASE("the air gives the height of a ramp, of a robot with wheels and of one without") {
  const auto ramp = [](double t) { return std::clamp(0.15 * (t - 20.0), 0.0, 3.0); };
  for (const bool wheels : {true, false}) {
    double largest_m = 0.0;
    HeightSource source = HeightSource::kNone;
    run({.wheels = wheels ? rolling(0.8, 0.0) : none(), .height_m = ramp}, 60.0,
        [&](double t, const Prior& prior) {
          largest_m = std::max(largest_m, std::abs(prior.height_m - ramp(t)));
          source = prior.height_source;
          CHECK_FALSE(prior.ground_moves);
        });
    CHECK(largest_m < 0.12);
    CHECK(source == HeightSource::kDifferential);
  }
}

TEST_CASE("a ride of a lift is seen while it lasts; it needs wheels that stand") {
  const auto lift = [](double t) { return std::clamp(1.0 * (t - 20.0), 0.0, 8.0); };
  double first_s = 0.0;
  double last_s = 0.0;
  run({.wheels = rolling(0.0, 0.0), .height_m = lift}, 50.0, [&](double t, const Prior& prior) {
    if (!prior.ground_moves) return;
    if (first_s == 0.0) first_s = t;
    last_s = t;
  });
  CHECK(first_s > 20.0);
  CHECK(first_s < 22.5);
  CHECK(last_s > 28.0);
  CHECK(last_s < 32.0);
  bool rides = false;
  run({.wheels = rolling(1.0, 0.0), .height_m = lift}, 50.0,
      [&](double, const Prior& prior) { rides = rides || prior.ground_moves; });
  CHECK_FALSE(rides);
}

TEST_CASE("a door's pulse of 8 Pa is no ride") {
  const auto door = [](double t) {
    return t > 20.0 && t < 21.5 ? 0.7 * std::sin((t - 20.0) / 1.5 * 3.14159) : 0.0;
  };
  run({.wheels = rolling(0.0, 0.0), .height_m = door}, 30.0,
      [](double, const Prior& prior) { CHECK_FALSE(prior.ground_moves); });
}

TEST_CASE("a stamp that is not newer gives no prior; a clock set back by more than 10 s begins anew") {
  PriorEstimator estimator(without_imu());
  Prior prior;
  CHECK(estimator.advance(at(50.0), prior));
  CHECK_FALSE(estimator.advance(at(50.0), prior));
  CHECK_FALSE(estimator.advance(at(49.0), prior));
  CHECK(estimator.advance(at(1.0), prior));
  CHECK(prior.stamp_ns == at(1.0));
}

}  // namespace isobar::test::test_without_imu
