// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/clock_verdicts.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/contradictions/motion_comparison.hpp"

namespace isobar::test::test_clock_verdicts {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

/// Turns that do not repeat themselves: bursts of random rates, 90 s at 50 Hz.
MotionSeries random_turns(double clock_s, unsigned noise_seed, double noise_rad_s = 0.02) {
  MotionSeries series;
  std::mt19937 path(7);
  std::mt19937 random(noise_seed);
  std::normal_distribution<double> rate(0.0, 0.4);
  std::normal_distribution<double> noise(0.0, noise_rad_s);
  double turn = 0.0;
  for (int i = 0; i < 4500; ++i) {
    if (i % 150 == 0) turn = i / 150 % 2 == 0 ? rate(path) : 0.0;
    series.add_rate(kStart + static_cast<std::int64_t>((0.02 * i + clock_s) * 1e9),
                    {turn + noise(random), 0, 0});
  }
  return series;
}

/// A turn of 3 s every 10 s, from `from_s` on.
MotionSeries laps(double from_s) {
  MotionSeries series;
  for (int i = 0; i < 4500; ++i) {
    const double t = 0.02 * i;
    if (t < from_s) continue;
    series.add_rate(kStart + static_cast<std::int64_t>(t * 1e9),
                    {std::fmod(t, 10.0) < 3.0 ? 0.5 : 0.0, 0, 0});
  }
  return series;
}

StreamTimes span(double from_s, double to_s) {
  StreamTimes times;
  times.add(kStart + static_cast<std::int64_t>(from_s * 1e9));
  times.add(kStart + static_cast<std::int64_t>(to_s * 1e9));
  return times;
}

AllStreamTimes all_spans(double imu_s, double wheels_s) {
  AllStreamTimes times;
  times[static_cast<std::size_t>(CheckedSensor::kLidar)] = span(0.0, 90.0);
  times[static_cast<std::size_t>(CheckedSensor::kImu)] = span(imu_s, imu_s + 90.0);
  times[static_cast<std::size_t>(CheckedSensor::kWheels)] = span(wheels_s, wheels_s + 90.0);
  return times;
}

Findings clock_findings(double imu_s, double wheels_s) {
  Findings findings;
  add_clock_findings({random_turns(imu_s, 1), random_turns(wheels_s, 2), random_turns(0.0, 3)},
                     all_spans(imu_s, wheels_s), findings);
  return findings;
}

}  // namespace

TEST_CASE("clocks that agree within a latency contradict nothing") {
  CHECK(clock_findings(0.0, 0.0).empty());
  CHECK(clock_findings(0.2, -0.2).empty());
}

TEST_CASE("a clock that is apart by 0.6 s to 40 s is told with its offset") {
  for (const double offset_s : {-40.0, -18.0, -1.0, 0.6, 5.0, 37.0}) {
    const Findings findings = clock_findings(offset_s, 0.0);
    REQUIRE(findings.all().size() == 1);
    CHECK(findings.all()[0].kind == Contradiction::kClocksApart);
    CHECK(findings.all()[0].sensor == CheckedSensor::kImu);
    CHECK(findings.all()[0].measured == doctest::Approx(offset_s).epsilon(0.01));
  }
}

TEST_CASE("one long turn tells the clock, too: its beginning") {
  const auto one_turn = [](double clock_s) {
    MotionSeries series;
    for (int i = 0; i < 2000; ++i) {
      const double t = 0.02 * i;
      series.add_rate(kStart + static_cast<std::int64_t>((t + clock_s) * 1e9), {t < 8.0 ? 0.0 : 0.3, 0, 0});
    }
    return series;
  };
  Findings findings;
  add_clock_findings({one_turn(-18.0), MotionSeries(), one_turn(0.0)}, all_spans(-18.0, 0.0), findings);
  REQUIRE(findings.all().size() == 1);
  CHECK(findings.all()[0].measured == doctest::Approx(-18.0).epsilon(0.01));
}

TEST_CASE("where IMU and wheels are apart from the lidar alike, the lidar's clock is off") {
  const Findings findings = clock_findings(18.0, 18.0);
  REQUIRE(findings.all().size() == 1);
  CHECK(findings.all()[0].sensor == CheckedSensor::kLidar);
  CHECK(findings.all()[0].measured == doctest::Approx(-18.0).epsilon(0.01));
}

TEST_CASE("laps that repeat themselves tell no clock to a stream that begins later") {
  for (const double from_s : {10.0, 20.0, 47.0}) {
    Findings findings;
    const MotionSeries none;
    add_clock_findings({laps(from_s), none, laps(0.0)}, all_spans(from_s, 0.0), findings);
    CHECK(findings.empty());
  }
}

TEST_CASE("turns that have nothing to do with each other tell no clock") {
  MotionSeries other;
  std::mt19937 random(11);
  std::normal_distribution<double> rate(0.0, 0.4);
  double turn = 0.0;
  for (int i = 0; i < 4500; ++i) {
    if (i % 130 == 0) turn = rate(random);
    other.add_rate(kStart + i * 20'000'000LL, {turn, 0, 0});
  }
  Findings findings;
  add_clock_findings({other, MotionSeries(), random_turns(0.0, 3)}, all_spans(0.0, 0.0), findings);
  CHECK(findings.empty());
}

TEST_CASE("a sensor without a common time is told; where it is the lidar, the lidar is named") {
  Findings imu;
  add_missing_overlaps(all_spans(-8 * 3600.0, 0.0), imu);
  REQUIRE(imu.all().size() == 1);
  CHECK(imu.all()[0].kind == Contradiction::kNoOverlap);
  CHECK(imu.all()[0].sensor == CheckedSensor::kImu);
  CHECK(imu.all()[0].measured == doctest::Approx(-8 * 3600.0));
  Findings lidar;
  add_missing_overlaps(all_spans(8 * 3600.0, 8 * 3600.0), lidar);
  REQUIRE(lidar.all().size() == 1);
  CHECK(lidar.all()[0].sensor == CheckedSensor::kLidar);
  CHECK(lidar.all()[0].measured == doctest::Approx(-8 * 3600.0));
  Findings none;
  add_missing_overlaps(all_spans(80.0, -80.0), none);
  CHECK(none.empty());
}

TEST_CASE("times of a stream: rate, gaps, overlap") {
  StreamTimes times;
  for (int i = 0; i < 100; ++i) times.add(kStart + (i < 50 ? i : i + 40) * 20'000'000LL);
  CHECK(times.gaps() == 1);
  CHECK(times.longest_gap_s() == doctest::Approx(0.82));
  CHECK(times.rate_hz() == doctest::Approx(99.0 / 2.78));
  CHECK(overlap_s(times, span(1.0, 9.0)) == doctest::Approx(1.78));
  CHECK(overlap_s(times, span(5.0, 9.0)) == doctest::Approx(-2.22));
}

}  // namespace isobar::test::test_clock_verdicts
