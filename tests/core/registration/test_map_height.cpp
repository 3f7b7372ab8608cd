// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/registration/map_height.hpp"
#include "tests/core/registration/height_drive.hpp"

namespace isobar::test::test_map_height {

namespace {

// A robot that stands in an elevator: 4 s of rest, 10 m in 12 s, and rest. The air sees the ground move from `seen_s` to
// `ended_s` after the start of the ride, and `zone_m` more upstairs.
struct Elevator {
  double seen_s = 0.8;
  double ended_s = 13.2;
  double zone_m = 0.0;

  MapHeight height{HeightDrive::kConfig};
  double risen_m = 0.0;

  void run(double until_s) {
    constexpr double kDtS = 0.005;
    constexpr double kAccelBias = 0.04;
    PriorHistory history;
    height.restart();
    Prior prior;
    double before_m_s = 0.0;
    double true_m = 0.0;
    std::int64_t stamp_ns = HeightDrive::kStartNs;
    for (double t = -4.0; t < until_s; t += kDtS) {
      const double ramp_s = std::clamp(std::min(t, 12.0 - t), 0.0, 2.0);
      const double speed_m_s = 0.5 * (1.0 - std::cos(0.5 * std::numbers::pi * ramp_s));
      true_m += speed_m_s * kDtS;
      prior.stamp_ns = stamp_ns += 5'000'000;
      prior.height_source = HeightSource::kDifferential;
      prior.velocity_valid = true;
      prior.up_accel_m_s2 = kAccelBias + (speed_m_s - before_m_s) / kDtS;
      prior.ground_moves = t >= seen_s && t < ended_s;
      prior.altimeter_m = true_m + zone_m * std::clamp(true_m / 10.0, 0.0, 1.0);
      prior.altimeter_variance_m2 = 0.0009;
      ++prior.altimeter_count;
      before_m_s = speed_m_s;
      history.add(prior);
      height.advance_to(prior.stamp_ns, history);
      risen_m += height.take_risen_m();
      if (prior.altimeter_count % 20 == 0) height.update(risen_m, 0.0, 1e-6, !height.riding(), {});
    }
  }
};

}  // namespace

TEST_CASE("a barometer that drifts moves the altimeter's bias and not the height") {
  for (const double rate_m_s : {0.02, 0.085, 0.17, 0.42}) {  // 0.25, 1, 2 and 5 Pa/s
    CAPTURE(rate_m_s);
    HeightDrive drive;
    drive.go(20.0);
    drive.altimeter = [&](double t) { return rate_m_s * std::max(0.0, t - 20.0); };
    drive.go(70.0);
    // Until the bias follows the drift, a part of it is taken for an error of the map.
    CHECK(std::abs(drive.corrected_m) < 0.1);
    CHECK(drive.height.bias_m() == doctest::Approx(rate_m_s * 70.0).epsilon(0.15));
    CHECK(drive.height.altimeter_faulty());
  }
}

TEST_CASE("a slow drift of a barometer moves the bias and not the height") {
  for (const double rate_m_s : {0.00085, 0.0021, 0.00425, 0.0085}) {  // 0.01, 0.025, 0.05 and 0.1 Pa/s
    for (const double sign : {1.0, -1.0}) {
      CAPTURE(sign * rate_m_s);
      HeightDrive drive;
      drive.turbulence_m = 0.03;
      drive.go(60.0);
      const double before_m = drive.corrected_m;
      drive.altimeter = [&](double t) { return sign * rate_m_s * std::max(0.0, t - 60.0); };
      drive.go(270.0);
      CHECK(std::abs(drive.corrected_m - before_m) < 0.1);
      CHECK(std::abs(drive.height.bias_m() - sign * rate_m_s * 270.0) < 0.2);
    }
  }
}

TEST_CASE(
    "a robot that stands for 50 minutes beside a barometer of 0.01 Pa/s keeps its height and says the "
    "drift") {
  HeightDrive drive;
  drive.speed_m_s = 0.0;
  drive.turbulence_m = 0.02;
  drive.go(60.0);
  drive.altimeter = [](double t) { return 0.00085 * std::max(0.0, t - 60.0); };
  drive.go(400.0);
  CHECK(drive.height.altimeter().drifts != DriftSuspect::kNone);
  drive.go(2600.0);
  CHECK(drive.height.altimeter_faulty());
  CHECK(std::abs(drive.corrected_m) < 0.01);
  CHECK(std::abs(drive.height.bias_m() - 0.00085 * 3000.0) < 0.15);
}

TEST_CASE("what a drift was taken for is withdrawn when the drift is said") {
  HeightDrive drive;
  drive.stays = 0.5;
  drive.go(20.0);
  drive.altimeter = [](double t) { return 0.03 * std::max(0.0, t - 20.0); };
  while (!drive.height.altimeter_faulty() && drive.t < 100.0) drive.go(0.1);
  REQUIRE(drive.height.altimeter_faulty());
  const double said_m = drive.corrected_m;
  drive.go(20.0);
  CHECK(std::abs(drive.corrected_m - said_m) < 0.002);
}

TEST_CASE("doors and zones move the altimeter's bias and not the height, and are no fault") {
  HeightDrive drive;
  drive.go(20.0);
  // Pulses of 8 Pa of 1.5 s every 15 s, in a zone of 4 Pa from half a minute on.
  drive.altimeter = [](double t) {
    return (std::fmod(t, 15.0) < 1.5 ? 0.68 : 0.0) + (t > 50.0 ? 0.34 : 0.0);
  };
  drive.go(120.0);
  CHECK(std::abs(drive.corrected_m) < 0.02);
  CHECK_FALSE(drive.height.altimeter_faulty());
}

TEST_CASE("over kilometres the altimeter keeps the map's height") {
  HeightDrive drive;
  drive.speed_m_s = 5.0;
  drive.stays = 0.5;  // at speed new ground comes sooner
  // The scans gain 1 m in 2 km, ten times what the random walk expects.
  drive.z = [](double t) { return t * 5.0 * 5e-4; };
  drive.go(400.0);
  CHECK(drive.corrected_m < -0.4);
  CHECK(drive.corrected_m > -1.05);
}

TEST_CASE("the variance of the height grows with the way, and not while the robot stands") {
  HeightDrive drive;
  drive.go(100.0);
  const double after_50_m = drive.height.variance_m2();
  CHECK(after_50_m > 1e-4);
  drive.speed_m_s = 0.0;
  drive.go(100.0);
  CHECK(drive.height.variance_m2() <= after_50_m);
}

TEST_CASE("a map that may be tilted is unsure of the height ahead from the first metres") {
  HeightDrive level;
  level.go(10.0);
  HeightDrive tilted;
  tilted.tilt_rad = 0.01;
  tilted.go(10.0);
  CHECK(std::sqrt(level.height.variance_m2()) < 0.025);
  CHECK(std::sqrt(tilted.height.variance_m2()) > 0.03);
}

TEST_CASE("without a base station the weather is the altimeter's") {
  HeightDrive drive;
  drive.source = HeightSource::kSingleBarometer;
  drive.altimeter = [](double t) { return 0.003 * t; };
  drive.go(300.0);
  CHECK(std::abs(drive.corrected_m) < 0.1);
}

TEST_CASE(
    "what the altimeter gains more on a ride than the cabin is its bias, and moves the height no further") {
  Elevator elevator{.zone_m = 0.3};
  elevator.run(30.0);
  CHECK_FALSE(elevator.height.riding());
  CHECK(std::abs(elevator.risen_m - 10.0) < 0.04);
  CHECK(std::abs(elevator.height.bias_m() - 0.3) < 0.05);
  CHECK_FALSE(elevator.height.altimeter_faulty());
}

TEST_CASE("air of the wrong temperature on a high ride is the altimeter's bias and no fault") {
  Elevator elevator{.zone_m = 0.9};  // 9 %, or 6 % and another zone
  elevator.run(60.0);
  CHECK(std::abs(elevator.risen_m - 10.0) < 0.06);
  CHECK(elevator.height.bias_m() > 0.8);
  CHECK_FALSE(elevator.height.altimeter_faulty());
}

TEST_CASE("a ride does not end while the acceleration has not stopped the cabin") {
  // At 1 m/s, without acceleration, as the air alone may see it.
  Elevator elevator{.ended_s = 6.0};
  elevator.run(8.0);
  CHECK(elevator.height.riding());
  Elevator arrived{.ended_s = 6.0};
  arrived.run(16.0);
  CHECK_FALSE(arrived.height.riding());
  CHECK(std::abs(arrived.risen_m - 10.0) < 0.05);
}

}  // namespace isobar::test::test_map_height
