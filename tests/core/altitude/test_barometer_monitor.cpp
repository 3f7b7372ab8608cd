// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/altitude/barometer_monitor.hpp"

namespace isobar::test::test_barometer_monitor {

namespace {

constexpr std::int64_t ns(double t) { return static_cast<std::int64_t>(t * 1e9); }

/// A sensor read every 1/hz seconds; `value` gives any pressure.
struct Sensor {
  BarometerMonitor monitor{AltimeterConfig{}};
  double hz = 32.0;
  double t = 0.0;

  double good(double at) const { return 1e5 + 0.3 * std::sin(1e3 * at); }
  template <class Value>
  void run(double until_s, const Value& value) {
    for (; t < until_s; t += 1.0 / hz) monitor.check({ns(t), value(t), 20.0}, ns(t));
  }
  void run_well(double until_s) {
    run(until_s, [this](double at) { return good(at); });
  }
  [[nodiscard]] BarometerFault fault() const { return monitor.fault(ns(t)); }
};

}  // namespace

TEST_CASE("a sensor that never sent is off, a working one is ok") {
  Sensor sensor;
  CHECK(sensor.fault() == BarometerFault::kOff);
  sensor.run_well(5.0);
  CHECK(sensor.fault() == BarometerFault::kOk);
}

TEST_CASE("silence is detected within half a second") {
  Sensor sensor;
  sensor.run_well(5.0);
  CHECK(sensor.monitor.fault(ns(5.0 + 0.3)) == BarometerFault::kOk);
  CHECK(sensor.monitor.fault(ns(5.0 + 0.45)) == BarometerFault::kOff);
  CHECK(sensor.monitor.lost(ns(5.0 + 0.45), 0.4));
  sensor.t = 7.0;
  sensor.run_well(7.2);
  CHECK(sensor.fault() == BarometerFault::kOk);
}

TEST_CASE("the silence of a slow sensor is judged by its own interval") {
  Sensor sensor;
  sensor.hz = 1.0;
  sensor.run_well(10.0);
  CHECK(sensor.monitor.fault(ns(10.9)) == BarometerFault::kOk);
  CHECK_FALSE(sensor.monitor.lost(ns(10.9), 0.4));
  CHECK(sensor.monitor.fault(ns(13.0)) == BarometerFault::kOff);
}

TEST_CASE("a stuck value is detected within two seconds; polling faster than the conversion is not a fault") {
  Sensor sensor;
  sensor.hz = 100.0;
  // A new value every 0.2 s: 20 equal samples in a row.
  const auto polled = [&](double at) { return sensor.good(std::floor(5.0 * at)); };
  sensor.run(10.0, polled);
  CHECK(sensor.fault() == BarometerFault::kOk);
  sensor.run(11.0, [](double) { return 1e5 + 0.25; });
  CHECK(sensor.fault() == BarometerFault::kOk);
  sensor.run(12.0, [](double) { return 1e5 + 0.25; });
  CHECK(sensor.fault() == BarometerFault::kStuck);
  CHECK(sensor.monitor.lost(ns(12.0), 0.4));
  sensor.run(12.5, polled);
  CHECK(sensor.fault() == BarometerFault::kOk);
}

TEST_CASE("implausible values are detected within two seconds") {
  for (const double wrong : {0.0, 2e5, std::numeric_limits<double>::quiet_NaN()}) {
    Sensor sensor;
    sensor.run_well(5.0);
    sensor.run(5.3, [&](double) { return wrong; });
    CHECK(sensor.fault() == BarometerFault::kOk);
    sensor.run(6.0, [&](double) { return wrong; });
    CHECK(sensor.fault() == BarometerFault::kWrong);
    sensor.run_well(6.2);
    CHECK(sensor.fault() == BarometerFault::kOk);
  }
}

TEST_CASE("three spikes in ten seconds are a fault, one is not, and the fault ends when the spikes do") {
  Sensor sensor;
  int number = 0;
  const auto spiking = [&](double at) { return ++number % 40 == 0 ? 9e4 : sensor.good(at); };
  sensor.run(2.0, spiking);
  CHECK(sensor.fault() == BarometerFault::kOk);
  sensor.run(10.0, spiking);
  CHECK(sensor.fault() == BarometerFault::kSpiking);
  sensor.run_well(40.0);
  CHECK(sensor.fault() == BarometerFault::kOk);
}

}  // namespace isobar::test::test_barometer_monitor
