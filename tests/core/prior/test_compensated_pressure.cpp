// SPDX-License-Identifier: BSD-3-Clause
// The barometers' calibrations, from PriorConfig to the height.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/prior/prior_estimator.hpp"

namespace isobar::test::test_compensated_pressure {

namespace {

/// -1.9 Pa/K about 25 degC, known between 10 and 40 degC.
CompensationConfig warm_sensor() {
  CompensationConfig config;
  config.model = CompensationModel::kSimple;
  config.pressure_centre_pa = 100'000.0;
  config.pressure_scale_pa = 5'000.0;
  config.temperature_centre_c = 25.0;
  config.temperature_scale_c = 10.0;
  config.coefficients.assign(16, 0.0);
  config.coefficients[0] = 100'000.0;
  config.coefficients[1] = -19.0;
  config.coefficients[4] = 5'000.0;
  config.range = {95'000.0, 105'000.0, 10.0, 40.0};
  return config;
}

struct Course {
  double from_c = 20.0;  ///< temperature of the sensor at the start of the minute
  double to_c = 40.0;    ///< at its end; nothing else changes
  bool base_warms = false;
  bool has_thermometer = true;
  std::uint8_t base_station = 0;
};

/// Height after a minute of standing still, while one of the two sensors warms up.
double height_after(const PriorConfig& config, const Course& course, PriorCounters& counters) {
  PriorEstimator estimator(config);
  Prior prior;
  for (int i = 0; i < 12'000; ++i) {
    const std::int64_t stamp_ns = i * 5'000'000LL;
    const double noise_pa = 0.2 * ((i / 6) % 5 - 2);  // so that the value never repeats
    const double temperature_c = course.from_c + (course.to_c - course.from_c) * i / 12'000.0;
    const double error_pa = 1.9 * (temperature_c - 25.0);
    const double shown_c = course.has_thermometer ? temperature_c : std::numeric_limits<double>::quiet_NaN();
    if (i % 6 == 0) {
      const bool warms = !course.base_warms;
      estimator.add_pressure({stamp_ns, 1e5 + noise_pa + (warms ? error_pa : 0.0), warms ? shown_c : 25.0});
    }
    if (i % 6 == 3) {
      PressureSample base{stamp_ns, 1e5 + noise_pa, 25.0};
      base.station = course.base_station;
      if (course.base_warms) {
        base.pressure_pa += error_pa;
        base.temperature_c = shown_c;
      }
      estimator.add_base_pressure(base);
    }
    ImuSample sample;
    sample.stamp_ns = stamp_ns;
    sample.accel_m_s2 = Eigen::Vector3d(0.0, 0.0, kGravity);
    if (i % 4 == 0) estimator.add_wheel({stamp_ns, 0.0, 0.0, 0.0});
    estimator.add_imu(sample, prior);
  }
  counters = estimator.counters();
  return prior.height_m;
}

}  // namespace

TEST_CASE("a sensor that warms up by 20 K moves the height by metres, a calibrated one does not") {
  PriorConfig config;
  PriorCounters counters;
  CHECK(std::abs(height_after(config, {}, counters)) >
        1.0);  // 38 Pa are 3.2 m; part of it counts as moving ground
  config.compensation = warm_sensor();
  CHECK(std::abs(height_after(config, {}, counters)) < 0.02);
  CHECK(counters.pressure_outside_calibration == 0);
  CHECK(counters.pressure_without_temperature == 0);
}

TEST_CASE("the base station's calibration applies to the first base station only") {
  PriorConfig config;
  PriorCounters counters;
  const Course course{.base_warms = true};
  config.compensation = warm_sensor();
  CHECK(std::abs(height_after(config, course, counters)) > 1.0);
  config.base_compensation = warm_sensor();
  CHECK(std::abs(height_after(config, course, counters)) < 0.02);
  CHECK(counters.base_outside_calibration == 0);
}

TEST_CASE("samples outside of the calibration are used and counted") {
  PriorConfig config;
  config.compensation = warm_sensor();
  PriorCounters counters;
  height_after(config, {.from_c = 30.0, .to_c = 50.0}, counters);
  // Half of the minute, at 33 samples a second, is above 40 degC.
  CHECK(counters.pressure_outside_calibration == doctest::Approx(1'000).epsilon(0.01));
  CHECK(counters.pressure_accepted > 1'900);
  height_after(config, {.has_thermometer = false}, counters);
  CHECK(counters.pressure_without_temperature == 2'000);
  CHECK(counters.pressure_accepted > 1'900);
}

}  // namespace isobar::test::test_compensated_pressure
