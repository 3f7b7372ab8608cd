// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/altitude/differential_altimeter.hpp"
#include "core/altitude/hypsometry.hpp"
#include "tests/core/altitude/isothermal_air.hpp"

namespace isobar::test::test_differential_altimeter {

namespace {

constexpr double kAirK = 293.15;

struct Scene {
  std::function<double(double)> height = [](double) { return 0.0; };
  std::function<double(double)> weather_pa = [](double) { return 0.0; };
  std::function<bool(double)> base_on = [](double) { return true; };
  double duration_s = 60.0;
  double base_hz = 16.0;
  double base_delay_s = 0.0;
  double noise_pa = 0.0;
  double sensor_offset_pa = 80.0;
};

struct Row {
  double t;
  AltimeterReading reading;
};

AltimeterConfig fixed_air() {
  AltimeterConfig config;
  config.air.mode = AirTemperatureMode::kFixed;
  config.air.fixed_c = kAirK - kZeroCelsiusK;
  return config;
}

std::int64_t at(double t) { return static_cast<std::int64_t>(std::llround(t * 1e9)); }

std::vector<Row> run(const Scene& scene) {
  DifferentialAltimeter altimeter(fixed_air());
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<Row> rows;
  double next_base = 0.0;
  for (int i = 0; i / 32.0 < scene.duration_s; ++i) {
    const double t = i / 32.0 + 0.01;
    for (; next_base + scene.base_delay_s <= t; next_base += 1.0 / scene.base_hz) {
      // Noise in the last digits, as in real sensors: a constant value would count as stuck.
      const double pa = 101'000.0 + scene.weather_pa(next_base) + scene.noise_pa * normal(random) +
                        1e-7 * std::sin(next_base);
      if (scene.base_on(next_base)) altimeter.add_base({at(next_base), pa, 20.0});
    }
    const double ground = 101'000.0 + scene.weather_pa(t);
    const double pa = hypsometric_pressure_pa(ground, 2.0 + scene.height(t), kAirK) + scene.sensor_offset_pa +
                      scene.noise_pa * normal(random) + 1e-7 * std::sin(t);
    Row row{t, {}};
    if (altimeter.add_robot({at(t), pa, 20.0}, row.reading) != PressureStatus::kAccepted) continue;
    if (row.reading.complete) rows.push_back(row);
  }
  return rows;
}

}  // namespace

TEST_CASE("height against a base station is the true height, whatever the weather and the sensors' offset") {
  Scene scene;
  scene.height = [](double t) { return 0.2 * t; };
  scene.weather_pa = [](double t) { return -0.05 * t; };
  for (const Row& row : run(scene)) {
    if (row.t < 2.0) continue;
    CHECK(row.reading.source == HeightSource::kDifferential);
    // Weather within the base's smoothing time when it joined (1 s, 0.05 Pa) and the scale error of the offset over
    // 12 m (80 Pa, 0.1 %).
    CHECK(std::abs(row.reading.height_m - 0.2 * static_cast<double>(row.reading.stamp_ns) * 1e-9) < 0.018);
  }
}

TEST_CASE(
    "without a base station the source is a single barometer, and the variance grows with the weather") {
  Scene scene;
  scene.base_on = [](double) { return false; };
  const auto rows = run(scene);
  CHECK(rows.front().reading.source == HeightSource::kSingleBarometer);
  CHECK(std::isinf(rows.front().reading.base_age_s));
  CHECK(rows.back().reading.source == HeightSource::kSingleBarometer);
  // Weather in a minute: hypot(0.025 Pa/s * 60 s, 0.2 Pa/sqrt(s) * sqrt(60 s)) = 2.16 Pa or 18.3 cm; the sensor's
  // noise adds some millimetres.
  CHECK(std::sqrt(rows.back().reading.variance_m2) == doctest::Approx(0.183).epsilon(0.05).scale(0.0));
}

TEST_CASE("a base that starts late does not move the height") {
  Scene scene;
  scene.base_on = [](double t) { return t > 20.0; };
  scene.height = [](double) { return 0.0; };
  const auto rows = run(scene);
  int joined = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    joined += rows[i].reading.event == ReferenceEvent::kBaseJoined ? 1 : 0;
    CHECK(std::abs(rows[i].reading.height_m - rows[i - 1].reading.height_m) < 1e-4);
  }
  CHECK(joined == 1);
  CHECK(rows.back().reading.source == HeightSource::kDifferential);
}

TEST_CASE("a base that falls silent and returns reports the weather in between") {
  Scene scene;
  scene.duration_s = 120.0;
  scene.base_on = [](double t) { return t < 20.0 || t > 80.0; };
  scene.weather_pa = [](double t) { return 0.05 * t; };
  const auto rows = run(scene);
  bool lost = false;
  bool returned = false;
  for (const Row& row : rows) {
    lost = lost || row.reading.event == ReferenceEvent::kBaseLost;
    if (row.reading.event != ReferenceEvent::kBaseReturned) continue;
    returned = true;
    // 60 s of 0.05 Pa/s, 8.5 cm/Pa: the height had sunk by 25.5 cm and comes back.
    CHECK(row.reading.weather_shift_m == doctest::Approx(0.255).epsilon(0.1).scale(0.0));
  }
  CHECK(lost);
  CHECK(returned);
  CHECK(std::abs(rows.back().reading.height_m) < 0.02);
  CHECK(rows.back().reading.source == HeightSource::kDifferential);
}

TEST_CASE("late and slow base samples change the height by less than 4 cm") {
  Scene scene;
  scene.base_hz = 1.0;
  scene.base_delay_s = 0.7;
  scene.weather_pa = [](double t) { return 0.05 * t; };
  for (const Row& row : run(scene)) {
    if (row.t < 4.0) continue;
    CHECK(row.reading.source == HeightSource::kDifferential);
    // Held for up to 2 s, plus smoothing over some seconds: at most 0.4 Pa.
    CHECK(std::abs(row.reading.height_m) < 0.04);
  }
}

TEST_CASE("the scatter of readings agrees with their noise variance") {
  Scene scene;
  scene.noise_pa = 0.4;
  scene.duration_s = 120.0;
  double sum = 0.0;
  double expected = 0.0;
  const auto rows = run(scene);
  for (std::size_t i = 50; i < rows.size(); ++i) {
    const double difference = rows[i].reading.height_m - rows[i - 1].reading.height_m;
    sum += 0.5 * difference * difference;
    expected += rows[i].reading.noise_variance_m2;
  }
  CHECK(sum == doctest::Approx(expected).epsilon(0.15));
}

}  // namespace isobar::test::test_differential_altimeter
