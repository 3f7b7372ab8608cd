// SPDX-License-Identifier: BSD-3-Clause
// What is the BMP390's own; what all barometers promise stands in tests/drivers/barometer.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "drivers/bmp390/sensor.hpp"
#include "tests/drivers/barometer/bench.hpp"
#include "tests/drivers/bmp390/chip_model.hpp"

namespace isobar::test::test_bmp390_sensor {

using namespace isobar::bmp390;

namespace {

using Bmp390Bench = BarometerBench<isobar::bmp390::ChipModel, Sensor, Settings>;

}  // namespace

TEST_CASE("every rate and oversampling that fit into a second give correct values at the rate") {
  for (const int rate_hz : {25, 50, 100, 200}) {
    for (int times = 1; times <= 32; times *= 2) {
      Settings settings;
      settings.rate_hz = rate_hz;
      settings.pressure_oversampling = times;
      if (busy_time_s(settings) >= 1.0) continue;
      CAPTURE(rate_hz);
      CAPTURE(times);
      Bmp390Bench bench(settings);
      bench.run(1.0);
      bench.samples.clear();
      bench.run(5.0);
      CHECK(static_cast<double>(bench.samples.size()) >= 5.0 * rate_hz * 0.97 - 1.0);
      CHECK(static_cast<double>(bench.samples.size()) <= 5.0 * rate_hz + 1.0);
      CHECK(bench.largest_error_pa() < 0.05);
    }
  }
}

TEST_CASE("settings that do not fit into a second are refused by the chip and said") {
  Settings settings;
  settings.rate_hz = 100;
  Bmp390Bench bench(settings);
  bench.run(2.0);
  CHECK(bench.samples.empty());
  CHECK(bench.fault() == "the chip refuses this oversampling at this rate");
}

TEST_CASE("the filter is off by default and follows its setting") {
  Bmp390Bench off;
  off.run(1.0);
  CHECK(off.chip.held(kConfig) == 0);
  Settings settings;
  settings.iir_coefficient = 7;
  Bmp390Bench on(settings);
  on.run(1.0);
  CHECK(on.chip.held(kConfig) == 0x06);  // 3 for 7
}

TEST_CASE("coefficients that do not fit their checksum are refused") {
  Bmp390Bench bench;
  bench.chip.coefficients[7] ^= 0x10;
  bench.chip.power_up();
  bench.run(2.0);
  CHECK(bench.samples.empty());
  CHECK(bench.sensor.status().state == DeviceState::kWrongDevice);
  CHECK(bench.fault() == "the coefficients do not fit their checksum");
}

TEST_CASE("a setting that does not arrive is noticed by reading it back, and written again") {
  Settings settings;
  settings.iir_coefficient = 7;
  settings.temperature_oversampling = 2;
  settings.rate_hz = 25;
  Bmp390Bench sound(settings);
  sound.run(2.0);
  for (std::uint64_t lost = 1; lost <= sound.chip.writes; ++lost) {
    Bmp390Bench bench(settings);
    bench.chip.lost_write = lost;
    bench.run(2.0);
    CAPTURE(lost);
    CHECK(bench.sensor.status().state == DeviceState::kMeasuring);
    for (const std::uint8_t address : {kOversampling, kRate, kConfig, kPowerControl}) {
      CHECK(bench.chip.held(address) == sound.chip.held(address));
    }
  }
}

TEST_CASE("no sample mixes two results, on a bus without bursts") {
  Bmp390Bench bench({}, 0, false);
  bench.late_ns = 20'000'000;
  bench.chip.byte_time_ns = 300'000;  // a read of a result takes 7 ms
  bench.chip.pressure_pa = [](double t_s) { return 96'000.0 + 2'000.0 * std::sin(3.0 * t_s); };
  bench.run(60.0);
  REQUIRE(bench.samples.size() > 1'000);
  CHECK(bench.sensor.status().counters.torn > 20);
  const Coefficients c = decode_coefficients(isobar::bmp390::kKnownBytes);
  // The temperature is constant, so that its raw value follows from a sample's.
  double d = 0.0;
  for (int i = 0; i < 10; ++i) {
    d -= (d * c.t[1] + d * d * c.t[2] - bench.samples.back().temperature_c) / (c.t[1] + 2.0 * d * c.t[2]);
  }
  const auto raw_temperature = static_cast<std::uint32_t>(std::lround(c.t[0] + d));
  std::vector<double> measured_pa;
  for (const std::uint32_t raw : bench.chip.pressures) {
    measured_pa.push_back(compensate(c, {raw, raw_temperature}).pressure_pa);
  }
  std::sort(measured_pa.begin(), measured_pa.end());
  const auto invented =
      std::count_if(bench.samples.begin(), bench.samples.end(), [&](const PressureSample& s) {
        const auto above = std::lower_bound(measured_pa.begin(), measured_pa.end(), s.pressure_pa - 1e-6);
        return above == measured_pa.end() || *above > s.pressure_pa + 1e-6;
      });
  CHECK(invented == 0);
}

}  // namespace isobar::test::test_bmp390_sensor
