// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/altitude/sensor_compensation.hpp"

namespace isobar::test::test_sensor_compensation {

using Result = SensorCompensation::Result;

namespace {

/// p_cal = p - 30 Pa - 1.9 Pa/K (t - 20) between 95 and 105 kPa, 0 and 40 degC, with curvature in p.
CompensationConfig calibrated() {
  CompensationConfig config;
  config.model = CompensationModel::kSimple;
  config.pressure_centre_pa = 100'000.0;
  config.pressure_scale_pa = 5'000.0;
  config.temperature_centre_c = 20.0;
  config.temperature_scale_c = 20.0;
  config.coefficients.assign(16, 0.0);
  config.coefficients[0] = 100'000.0 - 30.0;
  config.coefficients[1] = -38.0;
  config.coefficients[4] = 5'000.0;
  config.coefficients[8] = 6.0;
  config.range = {95'000.0, 105'000.0, 0.0, 40.0};
  config.sigma_pa = 0.4;
  return config;
}

PressureSample sample(double pressure_pa, double temperature_c) { return {0, pressure_pa, temperature_c}; }

}  // namespace

TEST_CASE("without a calibration a sample is unchanged") {
  SensorCompensation none;
  PressureSample s = sample(98'765.4, 21.0);
  CHECK(none.apply(s) == Result::kInside);
  CHECK(s.pressure_pa == 98'765.4);
  CHECK(std::isnan(s.variance_pa2));
}

TEST_CASE("within its range a calibration is eq. (1), and supplies a variance unknown to the sender") {
  SensorCompensation compensation(calibrated());
  PressureSample s = sample(102'500.0, 30.0);
  CHECK(compensation.apply(s) == Result::kInside);
  CHECK(s.pressure_pa == doctest::Approx(102'500.0 - 30.0 - 19.0 + 6.0 * 0.25).epsilon(1e-12));
  CHECK(s.variance_pa2 == doctest::Approx(0.16));
  s = sample(102'400.0, 30.0);
  s.variance_pa2 = 9.0;
  compensation.apply(s);
  CHECK(s.variance_pa2 == 9.0);
}

TEST_CASE("outside its range a calibration applies the correction of the nearest point inside") {
  SensorCompensation compensation(calibrated());
  const auto corrected = [&](double p, double t, Result expected) {
    PressureSample s = sample(p, t);
    CHECK(compensation.apply(s) == expected);
    return s.pressure_pa - p;
  };
  const double at_edge = corrected(95'000.0, 20.0, Result::kInside);
  CHECK(corrected(94'999.99, 20.0, Result::kOutside) == doctest::Approx(at_edge).epsilon(1e-4));
  CHECK(corrected(60'000.0, 20.0, Result::kOutside) == doctest::Approx(at_edge).epsilon(1e-9));
  CHECK(corrected(99'000.0, -25.0, Result::kOutside) ==
        doctest::Approx(-30.0 + 38.0 + 6.0 * 0.04).epsilon(1e-9));
}

TEST_CASE(
    "a sample without temperature is compensated with the last known one, initially the middle of the "
    "range") {
  SensorCompensation compensation(calibrated());
  PressureSample s = sample(100'000.0, NAN);
  CHECK(compensation.apply(s) == Result::kNoTemperature);
  CHECK(s.pressure_pa == doctest::Approx(99'970.0));
  s = sample(100'001.0, 30.0);
  compensation.apply(s);
  s = sample(100'000.0, NAN);
  CHECK(compensation.apply(s) == Result::kNoTemperature);
  CHECK(s.pressure_pa == doctest::Approx(99'951.0));
  CHECK(std::isnan(s.temperature_c));
}

TEST_CASE("a stuck pressure stays bit-identical while the temperature changes") {
  SensorCompensation compensation(calibrated());
  PressureSample first = sample(100'000.0, 20.0);
  PressureSample second = sample(100'000.0, 21.0);
  compensation.apply(first);
  compensation.apply(second);
  CHECK(first.pressure_pa == second.pressure_pa);
}

TEST_CASE("a model without temperature terms is valid without a temperature and at any temperature") {
  CompensationConfig config = calibrated();
  config.model = CompensationModel::kP;
  config.coefficients[1] = 0.0;
  SensorCompensation compensation(config);
  PressureSample s = sample(100'000.0, NAN);
  CHECK(compensation.apply(s) == Result::kInside);
  s = sample(100'010.0, 80.0);
  CHECK(compensation.apply(s) == Result::kInside);
}

TEST_CASE("a pressure that is not finite passes unchanged, for the gate to refuse") {
  SensorCompensation compensation(calibrated());
  PressureSample s = sample(NAN, 20.0);
  CHECK(compensation.apply(s) == Result::kInside);
  CHECK(std::isnan(s.pressure_pa));
}

TEST_CASE("an invalid calibration is refused with the key and the rule") {
  const auto broken = [](auto change) {
    CompensationConfig config = calibrated();
    change(config);
    const char* key = "";
    const char* rule = broken_compensation_rule(config, &key);
    return rule == nullptr ? std::string() : std::string(key) + " " + rule;
  };
  CHECK(broken([](auto&) {}).empty());
  CHECK(broken([](auto& c) { c.coefficients.pop_back(); }) == "coefficients must be sixteen numbers");
  CHECK(broken([](auto& c) { c.coefficients[5] = 0.1; }).find("must be zero where") != std::string::npos);
  CHECK(broken([](auto& c) { c.coefficients[0] -= 6'000.0; }).find("at most 5000 Pa") != std::string::npos);
  CHECK(broken([](auto& c) { c.coefficients[0] = NAN; }).find("at most 5000 Pa") != std::string::npos);
  CHECK(broken([](auto& c) { c.pressure_scale_pa = 0.0; }).find("at most 5000 Pa") != std::string::npos);
  CHECK(broken([](auto& c) { c.range.lowest_pa = 2e5; }).find("lowest_pressure_pa") != std::string::npos);
  CHECK(broken([](auto& c) { c.range.lowest_c = 50.0; }).find("lowest_temperature_c") != std::string::npos);
  CHECK(broken([](auto& c) { c = CompensationConfig{}; }).empty());
}

}  // namespace isobar::test::test_sensor_compensation
