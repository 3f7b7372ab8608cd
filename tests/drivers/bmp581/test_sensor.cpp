// SPDX-License-Identifier: BSD-3-Clause
// What is the BMP581's own; what all barometers promise stands in tests/drivers/barometer.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "drivers/bmp581/sensor.hpp"
#include "tests/drivers/barometer/bench.hpp"
#include "tests/drivers/bmp581/chip_model.hpp"

namespace isobar::test::test_bmp581_sensor {

using namespace isobar::bmp581;

namespace {

using Bmp581Bench = BarometerBench<isobar::bmp581::ChipModel, Sensor, Settings>;

}  // namespace

TEST_CASE("every rate and oversampling that fit into a second give correct values at the rate") {
  for (const Rate& rate : kRates) {
    for (int times = 1; times <= 128; times *= 2) {
      Settings settings;
      settings.rate_hz = rate.hz;
      settings.pressure_oversampling = times;
      settings.temperature_oversampling = std::max(1, times / 16);
      if (busy_time_s(settings) >= 0.95) continue;
      CAPTURE(rate.hz);
      CAPTURE(times);
      Bmp581Bench bench(settings);
      bench.run(1.5);
      bench.samples.clear();
      bench.run(5.0);
      CHECK(static_cast<double>(bench.samples.size()) >= 5.0 * rate.hz * 0.97 - 1.0);
      CHECK(static_cast<double>(bench.samples.size()) <= 5.0 * rate.hz * 1.01 + 1.0);
      CHECK(bench.largest_error_pa() < 1.0 / 64.0);
    }
  }
}

TEST_CASE("settings that do not fit into a second are refused by the chip and said") {
  Settings settings;
  settings.rate_hz = 50;
  settings.pressure_oversampling = 128;
  Bmp581Bench bench(settings);
  bench.run(2.0);
  CHECK(bench.samples.empty());
  CHECK(bench.fault() == "the chip refuses this oversampling at this rate");
}

TEST_CASE("the filter is off by default and follows its setting") {
  Bmp581Bench off;
  off.run(1.0);
  CHECK(off.chip.held(kDspIir) == 0);
  Settings settings;
  settings.iir_coefficient = 15;
  Bmp581Bench on(settings);
  on.chip.noise_pa = 1.0;
  on.run(20.0);
  CHECK(on.chip.held(kDspIir) == 0x24);  // 4 for 15, of both
  double sum = 0.0;
  for (const PressureSample& s : on.samples) sum += (s.pressure_pa - 96'000.0) * (s.pressure_pa - 96'000.0);
  // A first order filter with 1/16 leaves sqrt(1/31) of white noise.
  CHECK(std::sqrt(sum / static_cast<double>(on.samples.size())) == doctest::Approx(0.18).epsilon(0.25));
}

TEST_CASE("a chip whose memory is damaged, or never loaded, is reported") {
  Bmp581Bench damaged;
  damaged.chip.memory_damaged = true;
  damaged.run(2.0);
  CHECK(damaged.fault() == "the chip reports a damaged memory");
  Bmp581Bench never;
  never.chip.memory_ready_ns = std::int64_t{1} << 60;
  never.run(20.0);
  CHECK(never.samples.empty());
  CHECK(never.fault() == "the memory is not loaded 0.05 s after a reset");
  CHECK(never.sensor.status().counters.starts < 12);  // the wait doubles each time
}

TEST_CASE("a setting that does not arrive is noticed by reading it back, and written again") {
  Settings settings;
  settings.iir_coefficient = 7;
  settings.temperature_oversampling = 2;
  settings.rate_hz = 25;
  Bmp581Bench sound(settings);
  sound.run(2.0);
  for (std::uint64_t lost = 1; lost <= sound.chip.writes; ++lost) {
    Bmp581Bench bench(settings);
    bench.chip.lost_write = lost;
    bench.run(2.0);
    CAPTURE(lost);
    CHECK(bench.sensor.status().state == DeviceState::kMeasuring);
    for (const std::uint8_t address : {kDspConfig, kDspIir, kOsrConfig, kIntSource, kOdrConfig}) {
      CHECK(bench.chip.held(address) == sound.chip.held(address));
    }
  }
}

TEST_CASE("no sample mixes two results, on a bus without bursts") {
  Bmp581Bench bench({}, 0, false);
  bench.late_ns = 20'000'000;
  bench.chip.byte_time_ns = 300'000;  // a read of a result takes 7 ms
  bench.chip.pressure_pa = [](double t_s) { return 96'000.0 + 2'000.0 * std::sin(3.0 * t_s); };
  bench.run(60.0);
  REQUIRE(bench.samples.size() > 1'000);
  CHECK(bench.sensor.status().counters.torn > 20);
  const auto invented =
      std::count_if(bench.samples.begin(), bench.samples.end(), [&](const PressureSample& s) {
        return !bench.chip.pressures.contains(static_cast<std::uint32_t>(std::lround(s.pressure_pa * 64.0)));
      });
  CHECK(invented == 0);
}

}  // namespace isobar::test::test_bmp581_sensor
