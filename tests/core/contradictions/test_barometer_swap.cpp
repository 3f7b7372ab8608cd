// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/barometer_swap.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

namespace isobar::test::test_barometer_swap {

namespace {

PressureSeconds series_of(unsigned seed, const std::function<double(double)>& change_pa) {
  PressureSeconds series;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.5);
  for (int i = 0; i < 120 * 16; ++i) {
    PressureSample sample;
    sample.stamp_ns = 1'700'000'000'000'000'000 + i * 62'500'000LL;
    sample.pressure_pa = 101'000.0 + change_pa(i / 16.0) + noise(random);
    series.add(sample);
  }
  return series;
}

double still(double /*t*/) { return 0.0; }
/// An elevator, 4 m down from 40 s on.
double ride(double t) { return 48.0 * std::min(1.0, std::max(0.0, (t - 40.0) / 6.0)); }
/// Weather at its fastest.
double weather(double t) { return 0.05 * t; }
/// A door that slams: 40 Pa for a second, then back.
double door(double t) { return std::abs(t - 50.0) < 0.5 ? 40.0 : 0.0; }

}  // namespace

TEST_CASE("a base station that rides while the robot stands is told") {
  const auto finding = find_swapped_barometers(series_of(1, still), series_of(2, ride));
  REQUIRE(finding);
  CHECK(finding->kind == Contradiction::kBarometersSwapped);
  CHECK(finding->measured == doctest::Approx(48.0).epsilon(0.03));
}

TEST_CASE("a robot that rides, weather that both feel, and doors contradict nothing") {
  CHECK_FALSE(find_swapped_barometers(series_of(1, ride), series_of(2, still)));
  CHECK_FALSE(find_swapped_barometers(series_of(1, weather), series_of(2, weather)));
  CHECK_FALSE(find_swapped_barometers(series_of(1, still), series_of(2, weather)));
  CHECK_FALSE(find_swapped_barometers(series_of(1, still), series_of(2, door)));
  CHECK_FALSE(find_swapped_barometers(series_of(1, ride), series_of(2, ride)));
  CHECK_FALSE(find_swapped_barometers(series_of(1, still), PressureSeconds()));
  // A base in a van that climbs with the robot, further than it.
  CHECK_FALSE(
      find_swapped_barometers(series_of(1, [](double t) { return 0.5 * ride(t); }), series_of(2, ride)));
}

}  // namespace isobar::test::test_barometer_swap
