// SPDX-License-Identifier: BSD-3-Clause
// What is the ICP-20100's own; what all barometers promise stands in tests/drivers/barometer.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>

#include "drivers/icp20100/sensor.hpp"
#include "tests/drivers/barometer/bench.hpp"
#include "tests/drivers/icp20100/chip_model.hpp"

namespace isobar::test::test_icp20100_sensor {

using namespace isobar::icp20100;

namespace {

using Icp20100Bench = BarometerBench<isobar::icp20100::ChipModel, Sensor, Settings>;
constexpr double kBitPa = 40e3 / 131'072;

}  // namespace

TEST_CASE("every rate gives correct values at the rate, and none before the filter has settled") {
  for (const Mode& mode : kModes) {
    Icp20100Bench bench({.rate_hz = mode.rate_hz});
    bench.run(2.0);
    CHECK_FALSE(bench.samples.empty());
    CHECK(bench.largest_error_pa() < kBitPa);
    bench.samples.clear();
    bench.run(5.0);
    CHECK(static_cast<double>(bench.samples.size()) >= 5.0 * mode.rate_hz * 0.98 - 1.0);
    CHECK(static_cast<double>(bench.samples.size()) <= 5.0 * mode.rate_hz * 1.01 + 1.0);
    CHECK(bench.chip.held(kModeSelect) == (mode.number << 5 | 0x08));
  }
}

TEST_CASE("version A is trimmed from its memory once, and version B is left as it is") {
  for (const std::uint8_t version : {0x00, 0xB2}) {
    Icp20100Bench bench;
    bench.chip.version = version;
    bench.run(2.0);
    CHECK(bench.chip.trimmed());
    CHECK(bench.chip.held(kOtpStatus2) == (version == 0x00 ? 0x01 : 0x00));
    CHECK(bench.chip.held(kMasterLock) == 0x00);
    CHECK(bench.samples.size() > 100);
    CHECK(bench.largest_error_pa() < kBitPa);
    const std::uint64_t writes = bench.chip.writes;
    bench.chip.unplugged = true;
    bench.run(1.0);
    bench.chip.unplugged = false;  // not reset: the trimming is still there
    bench.run(5.0);
    CHECK(bench.sensor.status().state == DeviceState::kMeasuring);
    CHECK(bench.chip.writes - writes < 20);
  }
}

TEST_CASE("a memory that stays busy is reported and tried again") {
  Icp20100Bench bench;
  bench.chip.version = 0x00;
  bench.chip.memory_stays_busy = true;
  bench.run(3.0);
  CHECK(bench.samples.empty());
  CHECK(bench.fault() == "no answer (Connection timed out)");
  bench.chip.memory_stays_busy = false;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.0);
}

TEST_CASE("the mode is written only while the chip takes it") {
  Icp20100Bench bench;
  bench.chip.mode_sync_ns = 9'000'000;
  bench.run(2.0);
  CHECK(bench.chip.mode_writes_lost == 0);
  CHECK(bench.samples.size() > 100);
  Icp20100Bench never;
  never.chip.mode_sync_ns = std::int64_t{1} << 60;
  never.run(3.0);
  CHECK(never.samples.empty());
  CHECK(never.fault() == "the mode cannot be set: busy for 0.1 s");
}

TEST_CASE(
    "results that wait in the FIFO are all read, each with its own time; an overrun loses only itself") {
  Icp20100Bench bench;
  const double t0_s = static_cast<double>(bench.chip.now_ns()) * 1e-9;
  bench.chip.pressure_pa = [t0_s](double t_s) { return 100'000.0 - 80.0 * (t_s - t0_s); };
  bench.run(1.0);
  bench.samples.clear();
  const auto stall = [&](std::int64_t time_ns) {
    for (int i = 0; i < 40; ++i) {
      bench.chip.run_until(bench.chip.now_ns() + time_ns);
      bench.next_ns = bench.chip.now_ns();
      bench.run(0.25);
    }
  };
  stall(60'000'000);  // 7 results wait
  CHECK(bench.samples.size() > static_cast<std::size_t>(0.98 * 120 * 40 * 0.31));
  CHECK(bench.largest_error_pa() < 80.0 * 0.008 + kBitPa);
  for (std::size_t i = 1; i < bench.samples.size(); ++i) {
    CHECK(bench.samples[i].stamp_ns > bench.samples[i - 1].stamp_ns);
  }
  for (const bool keeps_oldest : {false, true}) {  // the data sheet leaves it open
    bench.chip.overrun_keeps_oldest = keeps_oldest;
    bench.samples.clear();
    stall(200'000'000);  // the FIFO overruns
    CHECK(bench.samples.size() > 120 * 40 * 0.2);
    CHECK(bench.largest_error_pa() < 80.0 * 0.008 + kBitPa);
  }
  CHECK(bench.sensor.status().counters.starts == 1);
}

}  // namespace isobar::test::test_icp20100_sensor
