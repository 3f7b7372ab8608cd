// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/contradictions/turn_verdicts.hpp"
#include "core/contradictions/way_verdicts.hpp"
#include "core/geometry.hpp"

namespace isobar::test::test_verdicts {

namespace {

/// A minute at 50 Hz: slow S-bends, with noise of 2 % of the rates.
struct Drive {
  double turn_scale = 1.0;
  double way_scale = 1.0;
  double way_angle_rad = 0.0;
  unsigned seed = 1;
  double seconds = 60.0;
};

MotionSeries series_of(const Drive& drive) {
  MotionSeries series;
  std::mt19937 random(drive.seed);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (int i = 0; i < static_cast<int>(drive.seconds * 50.0); ++i) {
    const double t = 0.02 * i;
    const double turn = 0.4 * std::sin(0.3 * t) + noise(random);
    const double speed = 0.8 + 0.3 * std::sin(0.7 * t) + noise(random);
    series.add_rate(1'000'000'000 + i * 20'000'000LL,
                    {drive.turn_scale * turn, drive.way_scale * speed * std::cos(drive.way_angle_rad),
                     drive.way_scale * speed * std::sin(drive.way_angle_rad)});
  }
  return series;
}

Findings turn_findings(double gyro, double wheels, bool with_wheels = true, bool points_down = false) {
  const MotionSeries g = series_of({.turn_scale = gyro, .seed = 2});
  const MotionSeries w = with_wheels ? series_of({.turn_scale = wheels, .seed = 3}) : MotionSeries();
  const MotionSeries s = series_of({});
  Findings findings;
  add_turn_findings({compare_turns(g, s), compare_turns(g, w), compare_turns(w, s)}, points_down, findings);
  return findings;
}

Findings way_findings(const Drive& wheels, const WayWitnesses& witnesses = {}, double scans_angle_rad = 0.0) {
  Findings findings;
  add_way_findings(compare_ways(series_of(wheels), series_of({.way_angle_rad = scans_angle_rad})), witnesses,
                   {0.0, 0.0, 10.0}, findings);
  return findings;
}

}  // namespace

TEST_CASE("sensors that agree, and wheels that slip by a third, contradict nothing") {
  CHECK(turn_findings(1.0, 1.0).empty());
  CHECK(turn_findings(1.0, 1.4).empty());
  CHECK(turn_findings(1.0, 0.6).empty());
  CHECK(turn_findings(1.0, 1.0, false).empty());
}

TEST_CASE("a gyro in deg/s is told against the wheels, and against the scans where there are no wheels") {
  for (const bool wheels : {true, false}) {
    const Findings findings = turn_findings(1.0 / kRadPerDeg, 1.0, wheels);
    REQUIRE(findings.all().size() == 1);
    const Finding& finding = findings.all()[0];
    CHECK(finding.kind == Contradiction::kGyroUnit);
    CHECK(finding.other == (wheels ? CheckedSensor::kWheels : CheckedSensor::kLidar));
    CHECK(finding.measured == doctest::Approx(57.3).epsilon(0.05));
    CHECK(finding.remedy[0] == doctest::Approx(kRadPerDeg));
    CHECK_FALSE(usable_sensors(findings).imu);
    CHECK(usable_sensors(findings).wheels);
  }
}

TEST_CASE("a gyro converted to rad/s twice is told") {
  const Findings findings = turn_findings(kRadPerDeg, 1.0);
  REQUIRE(findings.all().size() == 1);
  CHECK(findings.all()[0].kind == Contradiction::kGyroUnit);
  CHECK(findings.all()[0].remedy[0] == doctest::Approx(1.0 / kRadPerDeg));
}

TEST_CASE("wheels in deg/s are the wheels' fault, not the gyro's") {
  const Findings findings = turn_findings(1.0, 1.0 / kRadPerDeg);
  REQUIRE(findings.all().size() == 1);
  CHECK(findings.all()[0].kind == Contradiction::kWheelTurnUnit);
  CHECK(usable_sensors(findings).imu);
}

TEST_CASE("of three signs the one that differs is wrong") {
  const auto kind = [](double gyro, double wheels) {
    const Findings findings = turn_findings(gyro, wheels);
    REQUIRE(findings.all().size() == 1);
    return findings.all()[0].kind;
  };
  CHECK(kind(-1.0, 1.0) == Contradiction::kGyroMirrored);
  CHECK(kind(1.0, -1.0) == Contradiction::kWheelTurnReversed);
  CHECK(kind(-1.0, -1.0) == Contradiction::kLidarMirrored);
}

TEST_CASE("the sign of a gyro that is upside down is no fault of its own") {
  CHECK(turn_findings(-1.0, 1.0, true, true).empty());
}

TEST_CASE("a unit needs 0.3 rad of turning, a sign 0.7 rad") {
  TurnRatio turn{.ratio = 57.0, .correlation = 0.99, .turned_rad = 0.29, .windows = 3};
  CHECK(verdict_on(turn) == TurnVerdict::kUnclear);
  turn.turned_rad = 0.31;
  CHECK(verdict_on(turn) == TurnVerdict::kDegrees);
  turn.ratio = -1.0;
  CHECK(verdict_on(turn) == TurnVerdict::kUnclear);
  turn.turned_rad = 0.71;
  turn.correlation = -0.95;
  CHECK(verdict_on(turn) == TurnVerdict::kOpposite);
  turn.correlation = -0.85;
  CHECK(verdict_on(turn) == TurnVerdict::kUnclear);
}

TEST_CASE("wheels and scans that agree, within slip and a few degrees, contradict nothing") {
  CHECK(way_findings({.seed = 4}).empty());
  CHECK(way_findings({.way_scale = 1.5, .way_angle_rad = 0.2, .seed = 4}).empty());
}

TEST_CASE("wheels in km/h and in cm/s are told with their factor") {
  for (const double factor : {3.6, 100.0}) {
    const Findings findings = way_findings({.way_scale = factor, .seed = 4});
    REQUIRE(findings.all().size() == 1);
    CHECK(findings.all()[0].kind == Contradiction::kWheelUnit);
    CHECK(findings.all()[0].measured == doctest::Approx(factor).epsilon(0.05));
    CHECK(findings.all()[0].remedy[0] == doctest::Approx(1.0 / factor).epsilon(0.05));
    CHECK_FALSE(usable_sensors(findings).wheels);
  }
}

TEST_CASE("a lidar whose yaw is off by a right angle is told with the right one") {
  // Configured 10 deg, true 100: the scans seem to move 90 deg to the right of the wheels.
  const Findings findings = way_findings({.seed = 4}, {}, -0.5 * kPi);
  REQUIRE(findings.all().size() == 1);
  CHECK(findings.all()[0].kind == Contradiction::kLidarYaw);
  CHECK(findings.all()[0].measured == doctest::Approx(-90.0).epsilon(0.01));
  CHECK(findings.all()[0].remedy[2] == doctest::Approx(100.0));
  // A lidar that fits nothing leaves nothing to compare it with.
  CHECK(usable_sensors(findings) == UsableSensors{.imu = false, .wheels = false, .barometers = true});
}

TEST_CASE("backwards are the wheels or the lidar, as turn and acceleration tell") {
  const auto kind = [](const WayWitnesses& witnesses) {
    const Findings findings = way_findings({.way_scale = -1.0, .seed = 4}, witnesses);
    REQUIRE(findings.all().size() == 1);
    return findings.all()[0].kind;
  };
  CHECK(kind({}) == Contradiction::kWheelsOrLidar);
  CHECK(kind({.acceleration = 0.9}) == Contradiction::kLidarYaw);
  CHECK(kind({.acceleration = -0.9}) == Contradiction::kWheelsReversed);
  CHECK(kind({.acceleration = 0.1}) == Contradiction::kWheelsOrLidar);
  CHECK(kind({.acceleration = {}, .wheels_turn_reversed = true}) == Contradiction::kWheelsReversed);
}

TEST_CASE("the accelerometer feels the wheels' changes of speed, on a slope too, or their opposite") {
  const MotionSeries wheels = series_of({.seed = 4});
  for (const double sign : {1.0, -1.0}) {
    MotionSeries felt;
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.05);
    for (int i = 0; i < 12'000; ++i) {
      const double t = 0.005 * i;
      const double accel = sign * 0.3 * 0.7 * std::cos(0.7 * t) + 1.2 + noise(random);  // 7 deg of slope
      felt.add_rate(1'000'000'000 + i * 5'000'000LL, {0.0, accel, 0.0});
    }
    const auto correlation = compare_accelerations(felt, wheels);
    REQUIRE(correlation);
    CHECK(sign * *correlation > 0.8);
  }
  CHECK_FALSE(compare_accelerations(MotionSeries(), wheels));
}

}  // namespace isobar::test::test_verdicts
