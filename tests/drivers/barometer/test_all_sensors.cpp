// SPDX-License-Identifier: BSD-3-Clause
// What every barometer on a bus promises: rate, stamp, and each fault named within its time and survived.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "tests/drivers/barometer/sensors.hpp"

namespace isobar::test::test_all_sensors {

namespace {

constexpr std::int64_t kStuckNs = 1'500'000'000;

#define ISOBAR_ALL_SENSORS Bmp581, Bmp390, Icp20100, Ms5611

}  // namespace

TEST_CASE_TEMPLATE("first sample 0.5 s after the start, then at the configured rate", T, ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.run(0.5);
  CHECK_FALSE(bench.samples.empty());
  CHECK(bench.sensor.status().state == DeviceState::kMeasuring);
  bench.samples.clear();
  const std::uint64_t before = bench.steps;
  bench.run(10.0);
  const double expected = 10.0 * typename T::Settings().rate_hz;
  CHECK(static_cast<double>(bench.samples.size()) > 0.98 * expected - 2.0);
  CHECK(static_cast<double>(bench.samples.size()) < 1.01 * expected + 2.0);
  CHECK(bench.largest_error_pa() < T::kBitPa);
  for (const PressureSample& sample : bench.samples) {
    CHECK(sample.temperature_c == doctest::Approx(21.0).epsilon(1e-4));
    CHECK(sample.variance_pa2 == doctest::Approx(T::kVariancePa2));
  }
  CHECK(bench.steps - before < 2'600);  // 250 polls a second at most: the processor sleeps between them
  CHECK(bench.sensor.status().counters.starts == 1);
  CHECK(bench.fault().empty());
  CHECK(bench.sensor.place() == T::kPlace);
}

TEST_CASE_TEMPLATE("a sample's stamp is the time of its pressure, to 4 ms", T, ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  // 8 m/s of climb: 80 Pa/s.
  const double t0_s = static_cast<double>(bench.chip.now_ns()) * 1e-9;
  bench.chip.pressure_pa = [t0_s](double t_s) { return 100'000.0 - 80.0 * (t_s - t0_s); };
  bench.run(1.0);
  bench.samples.clear();
  bench.run(5.0);
  REQUIRE(bench.samples.size() > 100);
  double sum_pa = 0.0;
  for (const PressureSample& sample : bench.samples) {
    sum_pa += sample.pressure_pa - bench.chip.pressure_pa(static_cast<double>(sample.stamp_ns) * 1e-9);
  }
  CHECK(bench.largest_error_pa() < 80.0 * 0.004 + T::kBitPa);
  CHECK(std::abs(sum_pa / static_cast<double>(bench.samples.size())) < 80.0 * 0.002 + T::kBitPa / 2.0);
}

TEST_CASE_TEMPLATE(
    "an unplugged sensor is flagged within 0.5 s, retried at growing intervals, and used once it is back", T,
    ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.run(2.0);
  bench.chip.unplugged = true;
  CHECK(bench.time_until(DeviceState::kNoAnswer, 3.0) < 0.5);
  CHECK(bench.fault() == "no answer (Remote I/O error)");
  const std::size_t samples = bench.samples.size();
  const std::uint64_t transactions = bench.chip.transactions;
  bench.run(60.0);
  CHECK(bench.samples.size() == samples);
  CHECK(bench.chip.transactions - transactions < 40);
  CHECK(bench.sensor.status().counters.io_errors > 10);
  bench.chip.unplugged = false;
  bench.chip.power_up();
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 4.5);  // the longest wait is 4 s
  CHECK(bench.fault().empty());
  bench.run(1.0);
  CHECK(bench.largest_error_pa() < T::kBitPa);
}

TEST_CASE_TEMPLATE(
    "a bus that loses one transaction in a hundred loses samples, but the sensor keeps measuring", T,
    ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.run(1.0);
  bench.chip.nak_share = 0.01;
  bench.samples.clear();
  bench.run(100.0);
  CHECK(static_cast<double>(bench.samples.size()) > 90.0 * typename T::Settings().rate_hz);
  CHECK(bench.sensor.status().counters.starts == 1);
  CHECK(bench.sensor.status().counters.io_errors > 50);
  CHECK(bench.largest_error_pa() < T::kBitPa);
}

TEST_CASE_TEMPLATE("a sensor that answers without new results is reported within 0.5 s and set up again", T,
                   ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.run(2.0);
  bench.chip.stops = true;
  const std::size_t samples = bench.samples.size();
  bench.run(0.5);
  CHECK(bench.sensor.status().state != DeviceState::kMeasuring);
  CHECK_FALSE(bench.fault().empty());
  bench.run(1.0);
  CHECK(bench.samples.size() - samples < 3);
  CHECK(bench.sensor.status().counters.starts > 1);
  bench.chip.stops = false;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.5);
  CHECK(bench.sensor.status().counters.silent >= 1);
}

TEST_CASE_TEMPLATE(
    "a sensor whose bits freeze is reported within 2 s and gives no sample until they change again", T,
    ISOBAR_ALL_SENSORS) {
  typename T::Bench bench({}, kStuckNs);
  bench.chip.noise_pa = 5.0 * T::kNoisePa;
  bench.run(3.0);
  bench.chip.frozen = true;
  CHECK(bench.time_until(DeviceState::kStuck, 5.0) < 2.0);
  CHECK(bench.fault() == "the result no longer changes");
  const std::size_t samples = bench.samples.size();
  bench.run(20.0);
  CHECK(bench.samples.size() == samples);
  CHECK(bench.sensor.status().state == DeviceState::kStuck);
  CHECK(bench.sensor.status().counters.stuck == 1);
  bench.chip.frozen = false;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.5);
}

TEST_CASE_TEMPLATE("noise of the data sheet never counts as a frozen sensor", T, ISOBAR_ALL_SENSORS) {
  typename T::Bench bench({}, kStuckNs);
  bench.chip.noise_pa = T::kNoisePa;
  bench.run(120.0);
  CHECK(bench.sensor.status().counters.stuck == 0);
  CHECK(bench.sensor.status().counters.starts == 1);
}

TEST_CASE_TEMPLATE(
    "implausible values are refused, counted and reported within 0.5 s; good values clear the fault", T,
    ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.run(2.0);
  bench.chip.temperature_c = 95.0;
  bench.run(0.1);  // what is under way
  const std::size_t before = bench.samples.size();
  CHECK(bench.time_until(DeviceState::kImplausible, 3.0) < 0.5);
  CHECK(bench.fault() == "temperature outside -40 ... 85 degrees C");
  CHECK(bench.samples.size() == before);
  CHECK(bench.sensor.status().counters.implausible > 5);
  bench.chip.temperature_c = 21.0;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.5);
}

TEST_CASE_TEMPLATE(
    "a brown-out is detected by the lost settings and recovered in half a second, without a wrong sample", T,
    ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.run(2.0);
  for (int i = 0; i < 20; ++i) {
    bench.chip.power_up();
    bench.run(0.06);
    CHECK(bench.time_until(DeviceState::kMeasuring, 3.0) < 0.5);
    bench.run(3.0 + 0.0037 * i);  // each time in another phase of the measurement
  }
  CHECK(bench.sensor.status().counters.resets == 20);
  CHECK(bench.largest_error_pa() < T::kBitPa);
}

TEST_CASE_TEMPLATE("another device at the address is reported, and nothing is written to it", T,
                   ISOBAR_ALL_SENSORS) {
  typename T::Bench other;
  other.chip.become_another();
  other.run(1.0);
  CHECK(other.samples.empty());
  CHECK(other.sensor.status().state == DeviceState::kWrongDevice);
  CHECK(other.fault().find("another device") != std::string::npos);
  if (T::kIdentified) CHECK(other.chip.writes == 0);
}

TEST_CASE_TEMPLATE("a bus that cannot be opened is reported with the reason", T, ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  const auto words_for = [&](int error) {
    bench.bus->open_error = error;
    (void)bench.sensor.step(bench.chip.now_ns());
    return bench.fault();
  };
  CHECK(words_for(ENOENT) == "the bus cannot be opened (No such file or directory)");
  CHECK(words_for(EBUSY) == "a kernel driver holds the device (Device or resource busy)");
  CHECK(words_for(ENOTSUP) == "the bus has no SMBus byte reads and writes (Operation not supported)");
}

TEST_CASE_TEMPLATE("on a bus without bursts a sensor measures, or says what it needs", T,
                   ISOBAR_ALL_SENSORS) {
  typename T::Bench bench({}, 0, false);
  bench.late_ns = 10'000'000;
  bench.chip.byte_time_ns = 100'000;  // a read of a result takes 2.4 ms
  bench.chip.pressure_pa = [](double t_s) { return 96'000.0 + 2'000.0 * std::sin(3.0 * t_s); };
  bench.run(60.0);
  if (T::kNeedsBursts) {
    CHECK(bench.samples.empty());
    CHECK(bench.fault().find("no block reads") != std::string::npos);
    return;
  }
  REQUIRE(bench.samples.size() > 1'500);
  // 6 kPa/s of change, 40 ms of late calls and slow reads. Mixed results are looked for in each sensor's own
  // test.
  CHECK(bench.largest_error_pa() < 6'000.0 * 0.04);
}

TEST_CASE_TEMPLATE("a chip whose oscillator is 8 % slow, on a busy machine, still measures", T,
                   ISOBAR_ALL_SENSORS) {
  typename T::Bench bench;
  bench.chip.slow = 1.08;  // a conversion of the MS5611 may take 10 % longer than the typical time
  bench.late_ns = 5'000'000;
  bench.run(10.0);
  CHECK(static_cast<double>(bench.samples.size()) > 5.0 * typename T::Settings().rate_hz);
  CHECK(bench.sensor.status().counters.starts == 1);
  CHECK(bench.largest_error_pa() < T::kBitPa);
}

}  // namespace isobar::test::test_all_sensors
