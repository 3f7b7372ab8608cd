// SPDX-License-Identifier: BSD-3-Clause
// PressureFilter against InertialAltimeter, on an elevator and on stairs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/altitude/pressure_filter.hpp"
#include "core/calibration/filter_design.hpp"
#include "core/prior/inertial_altimeter.hpp"

namespace isobar::test::test_inertial_altimeter {

namespace {

constexpr double kSigmaPa = 0.35;
constexpr double kMPerPa = 0.085;
constexpr double kPressureDt = 1.0 / 32.0;
constexpr double kAccelDt = 0.01;
constexpr double kLagS = 1.0;

/// Piecewise linear vertical speed, its integral and its derivative.
struct Motion {
  struct Piece {
    double start_s;
    double accel_m_s2;
  };
  std::vector<Piece> pieces;

  [[nodiscard]] double accel(double time_s) const {
    double accel = 0.0;
    for (const Piece& piece : pieces) {
      if (time_s >= piece.start_s) accel = piece.accel_m_s2;
    }
    return accel;
  }
  [[nodiscard]] double height(double time_s) const {
    double height = 0.0;
    double speed = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const double end_s = i + 1 < pieces.size() ? pieces[i + 1].start_s : INFINITY;
      const double dt_s = std::clamp(time_s - pieces[i].start_s, 0.0, end_s - pieces[i].start_s);
      height += speed * dt_s + 0.5 * pieces[i].accel_m_s2 * dt_s * dt_s;
      speed += pieces[i].accel_m_s2 * dt_s;
    }
    return height;
  }
};

/// 15 m at 1.5 m/s, 1 m/s^2 to start and to stop.
const Motion kElevator{{{30.0, 1.0}, {31.5, 0.0}, {40.0, -1.0}, {41.5, 0.0}}};

/// A robot on stairs: 0.25 m/s, with a landing in the middle.
const Motion kStairs{{{30.0, 0.5},
                      {30.5, 0.0},
                      {38.0, -0.5},
                      {38.5, 0.0},
                      {42.0, 0.5},
                      {42.5, 0.0},
                      {50.0, -0.5},
                      {50.5, 0.0}}};

struct Errors {
  double largest_low_pass = 0.0;     // at the sample's time
  double largest_compensated = 0.0;  // at the stamp minus the delay, while the speed is constant
  double largest_inertial = 0.0;
};

/// Errors of the three during the motion, after some tens of seconds at rest.
Errors run(const Motion& motion, double end_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const FilterDesign design = design_for_lag(kSigmaPa, kPressureDt, kLagS);
  PressureFilter low_pass(design.walk_pa_sqrt_s);
  InertialAltimeter inertial{HeightConfig{}};
  const double bias_m_s2 = 0.04;
  Errors errors;
  double next_pressure_s = 0.0;
  double next_accel_s = 0.0;
  while (next_accel_s < end_s) {
    if (next_accel_s <= next_pressure_s) {
      // An accelerometer of 0.03 m/s^2 rms: the mean over its interval, as it integrates.
      const double up_m_s2 = motion.accel(next_accel_s - 0.5 * kAccelDt) + bias_m_s2 + 0.03 * normal(random);
      REQUIRE(inertial.add_acceleration(std::llround(next_accel_s * 1e9), up_m_s2) ==
              InertialAltimeter::Status::kUsed);
      if (next_accel_s > 25.0) {
        errors.largest_inertial =
            std::max(errors.largest_inertial, std::abs(inertial.height_m() - motion.height(next_accel_s)));
      }
      next_accel_s += kAccelDt;
      continue;
    }
    const double time_s = next_pressure_s;
    const double pressure_pa = 1e5 - motion.height(time_s) / kMPerPa + kSigmaPa * normal(random);
    low_pass.add(pressure_pa, kPressureDt, kSigmaPa * kSigmaPa);
    AltimeterReading reading;
    reading.stamp_ns = std::llround(time_s * 1e9);
    reading.height_m = (1e5 - pressure_pa) * kMPerPa;
    reading.noise_variance_m2 = std::pow(kSigmaPa * kMPerPa, 2);
    reading.source = HeightSource::kDifferential;
    inertial.add_height(reading);
    next_pressure_s += kPressureDt;
    if (time_s < 25.0) continue;
    const double low_pass_m = (1e5 - low_pass.pressure_pa()) * kMPerPa;
    errors.largest_low_pass = std::max(errors.largest_low_pass, std::abs(low_pass_m - motion.height(time_s)));
    // Five time constants after the last change of speed the transient is over.
    const bool constant_speed =
        motion.accel(time_s) == 0.0 &&
        std::all_of(motion.pieces.begin(), motion.pieces.end(), [&](const auto& piece) {
          return time_s < piece.start_s || time_s > piece.start_s + 5.0 * kLagS;
        });
    if (!constant_speed) continue;
    errors.largest_compensated = std::max(errors.largest_compensated,
                                          std::abs(low_pass_m - motion.height(time_s - low_pass.delay_s())));
  }
  return errors;
}

}  // namespace

TEST_CASE("on an elevator the low-pass lags by its stated delay; with acceleration there is no lag") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Errors errors = run(kElevator, 60.0, seed);
    // 1.5 m/s for a second, minus the transient of the corners, e^-8.5; four sigmas of noise, 0.75 cm rms.
    CHECK(errors.largest_low_pass == doctest::Approx(1.5 * kLagS).epsilon(0.025).scale(0.0));
    // Seven seconds into the ride: transient e^-5 (1 cm), and noise of 0.4 cm.
    CHECK(errors.largest_compensated < 0.03);
    // Error of the bias of some mm/s^2 over a ride, and the noise of the air in the filter's model.
    CHECK(errors.largest_inertial < 0.06);
  }
}

TEST_CASE("on stairs the low-pass errs by the height of a step, the inertial altimeter only by noise") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Errors errors = run(kStairs, 60.0, seed);
    CHECK(errors.largest_low_pass == doctest::Approx(0.25 * kLagS).epsilon(0.12).scale(0.0));
    CHECK(errors.largest_inertial < 0.06);
  }
}

TEST_CASE("the inertial altimeter estimates the accelerometer's bias, and its variance covers the error") {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  int inside = 0;
  constexpr int kRuns = 40;
  for (int trial = 0; trial < kRuns; ++trial) {
    HeightConfig config;
    InertialAltimeter inertial{config};
    const double bias_m_s2 = 0.05 * normal(random);
    // The filter's model of the air: Gauss-Markov, 4 cm over 10 s.
    double turbulence_m = config.turbulence_sigma_m * normal(random);
    double offset_m = 3.0;
    for (int i = 0; i < 6000; ++i) {
      const std::int64_t stamp_ns = 10'000'000LL * i;
      inertial.add_acceleration(stamp_ns, bias_m_s2 + 0.03 * normal(random));
      const double keep = std::exp(-kAccelDt / config.turbulence_time_s);
      turbulence_m =
          keep * turbulence_m + config.turbulence_sigma_m * std::sqrt(1.0 - keep * keep) * normal(random);
      if (i % 3 != 0) continue;
      AltimeterReading reading;
      reading.stamp_ns = stamp_ns;
      reading.height_m = offset_m + turbulence_m + 0.03 * normal(random);
      reading.noise_variance_m2 = 0.03 * 0.03;
      reading.source = HeightSource::kDifferential;
      inertial.add_height(reading);
    }
    // A minute of pressure determines the bias to 1 mm/s^2; the worst of 40 runs, with margin.
    CHECK(std::abs(inertial.accel_bias_m_s2() - bias_m_s2) < 0.005);
    if (std::abs(inertial.height_m()) < 2.0 * std::sqrt(inertial.variance_m2())) ++inside;
  }
  // 95 % of 40 are 38; fewer than 34 have a probability of 1 %.
  CHECK(inside >= 34);
}

TEST_CASE("a gap in the acceleration is bridged by the pressure, and invalid input is refused") {
  using Status = InertialAltimeter::Status;
  InertialAltimeter inertial{HeightConfig{}};
  AltimeterReading reading;
  reading.noise_variance_m2 = 1e-3;
  reading.source = HeightSource::kDifferential;
  CHECK(inertial.add_height(reading) == Status::kBadTime);
  CHECK(inertial.add_acceleration(0, std::numeric_limits<double>::quiet_NaN()) == Status::kBadValue);
  std::int64_t stamp_ns = 0;
  const auto stand = [&](double seconds, double height_m) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
      stamp_ns += 10'000'000;
      CHECK(inertial.add_acceleration(stamp_ns, 0.0) == Status::kUsed);
      reading.stamp_ns = stamp_ns;
      reading.height_m = height_m;
      CHECK(inertial.add_height(reading) == Status::kUsed);
    }
  };
  stand(30.0, 5.0);
  CHECK(std::abs(inertial.height_m()) < 0.01);
  CHECK(inertial.add_acceleration(stamp_ns, 0.0) == Status::kBadTime);
  reading.height_m = std::numeric_limits<double>::infinity();
  CHECK(inertial.add_height(reading) == Status::kBadValue);
  reading.height_m = 5.0;
  reading.stamp_ns = stamp_ns - 2'000'000'000;
  CHECK(inertial.add_height(reading) == Status::kBadTime);
  // 10 s without an IMU and 4 m up: the height is right again within a second.
  stamp_ns += 10'000'000'000;
  CHECK(inertial.add_acceleration(stamp_ns, 0.0) == Status::kUsed);
  CHECK(inertial.variance_m2() > 10.0);
  stand(1.0, 9.0);
  CHECK(inertial.height_m() == doctest::Approx(4.0).epsilon(0.02).scale(0.0));
}

}  // namespace isobar::test::test_inertial_altimeter
