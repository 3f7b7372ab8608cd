// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "simulation/atmosphere.hpp"
#include "simulation/barometer_model.hpp"

namespace isobar::test::test_air {

using namespace isobar::simulation;

namespace {

Scenario make_still_scenario() {
  Scenario scenario;
  scenario.raw.resize(20'001);  // 1000 s
  scenario.air.zone.assign(scenario.raw.size(), 0);
  scenario.air_temperature_c = 12.5;
  scenario.base_height_m = 3.0;
  scenario.start_pressure_pa = 99'000.0;
  return scenario;
}

}  // namespace

TEST_CASE("the hypsometric equation applied to pressure without errors gives the height") {
  const Scenario scenario = make_still_scenario();
  const Atmosphere air(scenario, AirErrors{}, Random(1));
  BarometerModel robot(BarometerErrors{}, Random(2));
  BarometerModel base(BarometerErrors{}, Random(3));
  for (const double height_m : {-60.0, -3.0, 0.0, 0.1, 12.0, 200.0}) {
    const double p1 = robot.sample(5.0, air.robot_pa(5.0, height_m), 12.5).pressure_pa;
    const double p0 = base.sample(5.0, air.base_pa(5.0), 12.5).pressure_pa;
    // dz = R T / g ln(p0 / p1), R = 287.05 J/(kg K), g = 9.80665 m/s^2
    const double dz = 287.05 * (273.15 + 12.5) / 9.80665 * std::log(p0 / p1);
    CHECK(dz == doctest::Approx(height_m - 3.0).epsilon(1e-9));
  }
}

TEST_CASE("weather acts equally on both sensors and changes by hectopascals in three hours") {
  const Scenario scenario = make_still_scenario();
  AirErrors errors = AirErrors::draw(Random(4));
  CHECK(std::abs(errors.ramp_pa_s) * 10'800.0 >= 100.0);
  errors.local_turbulence_pa = 0.0;
  errors.zone_sigma_pa = 0.0;
  errors.pulse_pa = 0.0;
  const Atmosphere air(scenario, errors, Random(5));
  CHECK(std::abs(air.base_pa(990.0) - air.base_pa(10.0)) > 3.0);
  for (double t = 1.0; t < 1000.0; t += 7.0) {
    const double dz = 287.05 * 285.65 / 9.80665 * std::log(air.base_pa(t) / air.robot_pa(t, 3.0));
    CHECK(std::abs(dz) < 1e-6);
  }
}

TEST_CASE(
    "a change of the ventilated zone shifts only the robot's pressure, by the equivalent of at most 35 cm") {
  Scenario scenario = make_still_scenario();
  for (std::size_t i = 10'000; i < scenario.air.zone.size(); ++i) scenario.air.zone[i] = 1;
  AirErrors errors;
  errors.zone_sigma_pa = 0.8;
  double largest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Atmosphere air(scenario, errors, Random(seed));
    CHECK(std::abs(air.robot_pa(499.0, 0.0) - air.robot_pa(5.0, 0.0)) < 1e-9);
    const double step = air.robot_pa(520.0, 0.0) - air.robot_pa(499.0, 0.0);
    CHECK(std::abs(step) * 0.0845 < 0.35);  // 8.45 cm/Pa at 12.5 degC and 990 hPa
    CHECK(std::abs(air.base_pa(520.0) - air.base_pa(499.0)) < 1e-9);
    largest = std::max(largest, std::abs(step));
  }
  CHECK(largest > 0.5);
}

TEST_CASE("a door causes a short pulse that is over two seconds later") {
  Scenario scenario = make_still_scenario();
  scenario.air.door_pulses_1_s = 1.0 / 60.0;
  AirErrors errors;
  errors.pulse_pa = 10.0;
  const Atmosphere air(scenario, errors, Random(6));
  const double rest_pa = scenario.start_pressure_pa;
  int disturbed = 0;
  double peak = 0.0;
  for (double t = 0.0; t < 1000.0; t += 0.1) {
    const double off = std::abs(air.robot_pa(t, 0.0) - rest_pa);
    peak = std::max(peak, off);
    disturbed += off > 0.1 ? 1 : 0;
  }
  CHECK(peak > 3.0);
  CHECK(peak < 20.0);
  CHECK(disturbed > 50);  // 1000 s with one pulse per minute, of about one second each
  CHECK(disturbed < 600);
}

TEST_CASE("zones, door pulses and the flow at the port have the sizes asked for") {
  Scenario scenario = make_still_scenario();
  for (std::size_t i = 0; i < scenario.air.zone.size(); ++i) {
    scenario.air.zone[i] = static_cast<int>(i / 1000);  // twenty zones of 50 s
  }
  scenario.air.zones = PressureRange{1.0, 4.0};
  const Atmosphere zoned(scenario, AirErrors{}, Random(1));
  int up = 0;
  for (int zone = 0; zone < 20; ++zone) {
    const double offset_pa = zoned.robot_pa(50.0 * zone + 45.0, 0.0) - scenario.start_pressure_pa;
    CHECK(std::abs(offset_pa) > 0.99);
    CHECK(std::abs(offset_pa) < 4.01);
    up += offset_pa > 0.0 ? 1 : 0;
  }
  CHECK(up > 2);
  CHECK(up < 18);

  scenario = make_still_scenario();
  scenario.air.door_pulses_1_s = 1.0 / 60.0;
  scenario.air.pulses = PressureRange{7.0, 8.0};
  AirErrors errors;
  errors.pulse_pa = 1.0;
  const Atmosphere pulsed(scenario, errors, Random(2));
  double largest_pa = 0.0;
  for (double t = 0.0; t < 1000.0; t += 0.01) {
    largest_pa = std::max(largest_pa, std::abs(pulsed.robot_pa(t, 0.0) - scenario.start_pressure_pa));
  }
  CHECK(largest_pa > 6.0);   // the spline of 0.05 s rounds the peak of a half sine wave of 0.3 s or more
  CHECK(largest_pa < 16.1);  // two at once

  scenario = make_still_scenario();
  for (std::size_t i = 0; i < scenario.raw.size(); ++i) scenario.raw[i].x_m = 0.15 * static_cast<double>(i);
  scenario.air.port_coefficient = -1.0 / 3.0;
  const Atmosphere flown(scenario, AirErrors{}, Random(3));
  CHECK(flown.robot_pa(500.0, 0.0) - scenario.start_pressure_pa == doctest::Approx(-1.8));  // at 3 m/s
}

TEST_CASE(
    "gusts of wind: pascals at both ports, independent of each other; the mean is the share of the "
    "dynamic pressure") {
  Scenario scenario = make_still_scenario();
  scenario.air.wind_m_s = 5.0;
  scenario.air.port_wind_share = 0.2;
  scenario.air.base_wind_share = -0.1;
  const Atmosphere air(scenario, AirErrors{}, Random(8));
  const double base_rest_pa = Atmosphere(make_still_scenario(), AirErrors{}, Random(8)).base_pa(10.0);
  double robot_sum = 0.0;
  double base_sum = 0.0;
  double robot_square = 0.0;
  double base_square = 0.0;
  double product = 0.0;
  int count = 0;
  for (double t = 20.0; t < 1000.0; t += 0.5) {
    const double robot_pa = air.robot_pa(t, 0.0) - scenario.start_pressure_pa;
    const double base_pa = air.base_pa(t) - base_rest_pa;
    robot_sum += robot_pa;
    base_sum += base_pa;
    robot_square += robot_pa * robot_pa;
    base_square += base_pa * base_pa;
    product += robot_pa * base_pa;
    ++count;
  }
  const double robot_mean = robot_sum / count;
  const double base_mean = base_sum / count;
  // 0.6 kg/m^3 (25 + 0.09 * 25) m^2/s^2 = 16.4 Pa, less the low-pass. Eddies of 5 s in 980 s: 98 independent
  // ones, an rms of 60 % of the mean: 6 %, at three sigma 18 %.
  CHECK(robot_mean == doctest::Approx(0.2 * 16.2).epsilon(0.2));
  CHECK(base_mean == doctest::Approx(-0.1 * 16.2).epsilon(0.2));
  const double robot_sd = std::sqrt(robot_square / count - robot_mean * robot_mean);
  const double base_sd = std::sqrt(base_square / count - base_mean * base_mean);
  CHECK(robot_sd > 1.0);
  CHECK(robot_sd < 3.0);
  const double correlation = (product / count - robot_mean * base_mean) / (robot_sd * base_sd);
  CHECK(std::abs(correlation) < 0.4);  // of 98 independent samples: 0.1, at four sigma
}

TEST_CASE("during warm-up, pressure and temperature follow the same exponential") {
  BarometerErrors errors;
  errors.warm_up_k = 3.0;
  errors.warm_up_tau_s = 200.0;
  errors.powered_for_s = 100.0;
  errors.drift_pa_k = 0.4;
  BarometerModel barometer(errors, Random(7));
  for (const double t : {0.0, 50.0, 400.0}) {
    const PressureSample sample = barometer.sample(t, 100'000.0, 20.0);
    const double warm = 3.0 * (1.0 - std::exp(-(t + 100.0) / 200.0));
    CHECK(sample.temperature_c == doctest::Approx(20.0 + warm));
    CHECK(sample.pressure_pa - 100'000.0 == doctest::Approx(0.4 * warm).epsilon(1e-6));
  }
}

}  // namespace isobar::test::test_air
