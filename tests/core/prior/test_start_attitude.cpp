// SPDX-License-Identifier: BSD-3-Clause
// Roll and pitch of a robot that stands in the first seconds, shaken by its engine.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/prior/prior_estimator.hpp"
#include "core/prior/rest_gravity.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_start_attitude {

namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;

/// Vibration of a running engine: lines with drawn frequencies and phases.
struct Shaking {
  double force_m_s2 = 0.0;  ///< rms of an axis
  double rate_rad_s = 0.0;  ///< rms of an axis
  double lowest_hz = 8.0;
  double highest_hz = 30.0;
  bool wheels = true;
};

struct Line {
  double hz;
  double amplitude;
  double phase_rad;
};

struct Axis {
  std::array<Line, 5> lines;
  [[nodiscard]] double at(double t) const {
    double sum = 0.0;
    for (const Line& line : lines)
      sum += line.amplitude * std::sin(2.0 * M_PI * line.hz * t + line.phase_rad);
    return sum;
  }
};

Axis draw_axis(const Shaking& shaking, double rms, std::mt19937& random) {
  std::uniform_real_distribution<double> hz(shaking.lowest_hz, shaking.highest_hz);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * M_PI);
  Axis axis{};
  for (Line& line : axis.lines) line = {hz(random), rms * std::sqrt(2.0 / 5.0), phase(random)};
  return axis;
}

struct Errors {
  double after_start_deg = 0.0;
  double after_five_deg = 0.0;
  double normalised = 0.0;  ///< error after five seconds over its sigma
};

/// Error of the up direction of a robot that stands on a slope.
Errors run(const Shaking& shaking, unsigned seed) {
  PriorEstimator estimator{PriorConfig{}};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::array<Axis, 6> axes{};
  for (std::size_t i = 0; i < 6; ++i) {
    axes[i] = draw_axis(shaking, i < 3 ? shaking.force_m_s2 : shaking.rate_rad_s, random);
  }
  const Eigen::Quaterniond tilt = exp_so3({0.1, -0.07, 0.0});
  const Eigen::Vector3d up = tilt.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d gyro_bias = 0.003 * Eigen::Vector3d(normal(random), normal(random), normal(random));
  Errors errors;
  for (int i = 0; i <= 1040; ++i) {
    const double t = 0.005 * i;
    const auto stamp_ns = static_cast<std::int64_t>(t * 1e9) + 1'000'000'000;
    if (shaking.wheels && i % 4 == 0) estimator.add_wheel({stamp_ns - 1, 0.0, 0.0, 0.0});
    ImuSample sample;
    sample.stamp_ns = stamp_ns;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      sample.accel_m_s2[axis] = 9.80665 * up[axis] + axes[k].at(t) + 0.01 * normal(random);
      sample.gyro_rad_s[axis] = gyro_bias[axis] + axes[3 + k].at(t) + 0.005 * normal(random);
    }
    Prior prior;
    estimator.add_imu(sample, prior);
    const Eigen::Vector3d seen = prior.T_odom_base.linear().transpose() * Eigen::Vector3d::UnitZ();
    const double error_deg = std::acos(std::min(1.0, seen.dot(up))) / kDeg;
    if (i == 110) errors.after_start_deg = error_deg;
    if (i < 1000) continue;
    errors.after_five_deg = std::max(errors.after_five_deg, error_deg);
    errors.normalised = error_deg * kDeg / std::sqrt(2.0 * prior.roll_pitch_variance_rad2);
  }
  return errors;
}

}  // namespace

TEST_CASE(
    "after five seconds at rest roll and pitch are good to 0.2 deg, on wheels and without, with the engine "
    "on") {
  for (const double force_m_s2 : {0.3, 1.0, 3.0}) {
    for (const double rate_rad_s : {0.0, 0.02}) {
      for (const bool wheels : {true, false}) {
        CAPTURE(force_m_s2);
        CAPTURE(rate_rad_s);
        CAPTURE(wheels);
        Shaking shaking;
        shaking.force_m_s2 = force_m_s2;
        shaking.rate_rad_s = rate_rad_s;
        shaking.wheels = wheels;
        Errors sum;
        double worst_deg = 0.0;
        for (unsigned seed = 1; seed <= 10; ++seed) {
          const Errors errors = run(shaking, seed);
          sum.after_start_deg += 0.1 * errors.after_start_deg;
          sum.after_five_deg += 0.1 * errors.after_five_deg;
          worst_deg = std::max(worst_deg, errors.after_five_deg);
          CHECK(errors.normalised < 2.0);
        }
        // A line of 3 m/s^2 rms at 8 Hz leaves up to 0.6 deg in each window of 0.6 s.
        const bool strong = force_m_s2 > 2.0;
        CHECK(sum.after_five_deg < (strong ? 0.3 : 0.13));
        CHECK(worst_deg < (strong ? 0.6 : 0.22));
        if (strong) CHECK(sum.after_five_deg < 0.5 * sum.after_start_deg);
      }
    }
  }
}

TEST_CASE("a platform that swings is no platform at rest: its force points along the rope") {
  RestGravity gravity;
  RestGravity::Measurement still;
  RestGravity::Measurement swinging;
  StandstillDetector::Rest window;
  window.force_variance = 1e-4;
  // Swing of 1 deg in 9 s: rates to 0.012 rad/s, and a force along the rope, constant in the platform's axes.
  for (int i = 0; i < 8; ++i) {
    window.force_m_s2 = {0.0, 0.0, 9.8};
    window.gyro_rad_s = {0.0, 0.0122 * std::cos(0.7 * 0.6 * i), 0.0};
    CHECK(gravity.add(window, false, swinging) == (i >= 2));
  }
  gravity.restart();
  for (int i = 0; i < 8; ++i) {
    window.gyro_rad_s = {0.0, 0.0122, 0.0};  // a gyro's bias
    gravity.add(window, false, still);
  }
  CHECK(std::sqrt(swinging.variance) / 9.8 > 1.0 * kDeg);
  CHECK(std::sqrt(still.variance) / 9.8 < 0.15 * kDeg);
  CHECK(std::sqrt(swinging.rate_variance) > 0.0122);
  // On wheels nothing swings.
  CHECK(gravity.add(window, true, still));
  CHECK(still.variance == doctest::Approx(1e-4));
}

TEST_CASE(
    "the mean force of a window is trusted as its parts agree: vibration averages out, rocking does not") {
  const auto variance_of = [](double hz) {
    StandstillDetector detector{StandstillConfig{}};
    for (int i = 0; i < 130; ++i) {
      const double t = 0.005 * i;
      detector.add_wheel(0.0, 0.0);
      detector.add_imu(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.01,
                       {std::sin(2.0 * M_PI * hz * t), 0.0, 9.8}, 0.005);
    }
    StandstillDetector::Rest rest;
    REQUIRE(detector.take_rest(rest));
    CHECK_FALSE(detector.take_rest(rest));
    return rest.force_variance;
  };
  CHECK(std::sqrt(variance_of(20.0)) < 0.02);
  CHECK(std::sqrt(variance_of(1.0)) > 0.15);
}

}  // namespace isobar::test::test_start_attitude
