// SPDX-License-Identifier: BSD-3-Clause
// What is the MS5611's own; what all barometers promise stands in tests/drivers/barometer.
#include <doctest/doctest.h>

#include "drivers/ms5611/sensor.hpp"
#include "tests/drivers/barometer/bench.hpp"
#include "tests/drivers/ms5611/chip_model.hpp"

namespace isobar::test::test_ms5611_sensor {

using namespace isobar::ms5611;

namespace {

using Ms5611Bench = BarometerBench<isobar::ms5611::ChipModel, Sensor, Settings>;

}  // namespace

TEST_CASE("every oversampling gives correct values at the rate, and no read comes into a conversion") {
  for (const int rate_hz : {1, 10, 50}) {
    for (int times = 256; times <= 4096; times *= 2) {
      Ms5611Bench bench(
          {.rate_hz = rate_hz, .pressure_oversampling = times, .temperature_oversampling = times});
      bench.chip.slow = 1.09;            // the longest conversion is 10 % longer than the typical one
      bench.chip.byte_time_ns = 90'000;  // 100 kHz
      bench.run(1.0);
      bench.samples.clear();
      bench.run(5.0);
      CAPTURE(rate_hz);
      CAPTURE(times);
      if (busy_time_s(
              {.rate_hz = rate_hz, .pressure_oversampling = times, .temperature_oversampling = times}) <
          0.8) {
        CHECK(static_cast<double>(bench.samples.size()) >= 5.0 * rate_hz * 0.95 - 1.0);
        CHECK(static_cast<double>(bench.samples.size()) <= 5.0 * rate_hz + 1.0);
      }
      CHECK(bench.largest_error_pa() < 0.03);
      CHECK(bench.chip.spoiled == 0);
    }
  }
}

TEST_CASE("a memory whose checksum is wrong is refused, with the reason") {
  Ms5611Bench bench;
  bench.chip.prom[7] ^= 0x0001;
  bench.run(2.0);
  CHECK(bench.samples.empty());
  CHECK(bench.sensor.status().state == DeviceState::kWrongDevice);
  CHECK(bench.fault() == "the coefficients do not fit their checksum: another device?");
}

TEST_CASE("another sensor plugged in between two measurements is read with its own coefficients") {
  Ms5611Bench bench;
  bench.run(2.0);
  Prom other = isobar::ms5611::kKnownProm;
  other[0] = 0x1234;  // the reserved word alone is no coefficient
  bench.chip.prom = sealed(other);
  bench.run(1.0);
  CHECK(bench.sensor.status().counters.resets == 0);
  other[3] += 100;
  bench.chip.prom = sealed(other);
  bench.run(1.0);
  CHECK(bench.sensor.status().counters.resets == 1);
  CHECK(bench.sensor.status().state == DeviceState::kMeasuring);
}

}  // namespace isobar::test::test_ms5611_sensor
