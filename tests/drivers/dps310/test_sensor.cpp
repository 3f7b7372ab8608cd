// SPDX-License-Identifier: BSD-3-Clause
// The driver against a model of the chip, sound and with faults of the data sheet and of the field.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "drivers/bus/smbus.hpp"
#include "drivers/dps310/sensor.hpp"
#include "tests/drivers/dps310/chip_model.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_sensor {

using namespace isobar::dps310;
using isobar::dps310::ChipModel;
using isobar::dps310::ModelBus;

namespace {

constexpr std::int64_t kStuckNs = 1'500'000'000;

Settings with_rates(int pressure_hz, int pressure_times, int temperature_hz, int temperature_times) {
  Settings settings;
  settings.pressure_rate_hz = pressure_hz;
  settings.pressure_oversampling = pressure_times;
  settings.temperature_rate_hz = temperature_hz;
  settings.temperature_oversampling = temperature_times;
  return settings;
}

/// Chip, driver and clock; steps the driver at the times that it asks for.
struct Bench {
  /// Air without noise gives constant bits: the detection of a stuck sensor needs noise.
  explicit Bench(const Settings& settings = {}, std::int64_t stuck_ns = 0)
      : sensor(settings, std::make_unique<ModelBus>(chip), stuck_ns) {}

  void run(double seconds) {
    const std::int64_t end_ns = chip.now_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (next_ns < end_ns) {
      chip.run_until(next_ns + std::uniform_int_distribution<std::int64_t>(0, late_ns)(random));
      const std::int64_t called_ns = chip.now_ns();
      const Device<PressureSample>::Step step = sensor.step(called_ns);
      ++steps;
      REQUIRE(step.next_ns > called_ns);
      next_ns = step.next_ns;
      if (step.has_sample) samples.push_back(step.sample);
    }
    chip.run_until(end_ns);
  }
  /// Runs until the driver reports this state.
  /// @return time until then, or the limit [s]
  double time_until(DeviceState state, double limit_s) {
    const std::int64_t start_ns = chip.now_ns();
    const auto elapsed_s = [&] { return static_cast<double>(chip.now_ns() - start_ns) * 1e-9; };
    while (sensor.status().state != state && elapsed_s() < limit_s) run(0.005);
    return elapsed_s();
  }
  [[nodiscard]] std::string fault() const { return sensor.status().fault.data(); }
  [[nodiscard]] double largest_error_pa(double truth_pa) const {
    double largest = 0.0;
    for (const PressureSample& s : samples) largest = std::max(largest, std::abs(s.pressure_pa - truth_pa));
    return largest;
  }

  ChipModel chip;
  Sensor sensor;
  std::int64_t next_ns = 0;
  std::int64_t late_ns = 0;  ///< largest delay of a call, as on a busy machine
  std::mt19937 random{5};
  std::uint64_t steps = 0;
  std::vector<PressureSample> samples;
};

}  // namespace

TEST_CASE("first sample 0.3 s after power-up, then at the configured rate") {
  Bench bench;
  bench.run(0.3);
  CHECK_FALSE(bench.samples.empty());
  CHECK(bench.sensor.status().state == DeviceState::kMeasuring);
  bench.samples.clear();
  bench.run(10.0);
  CHECK(bench.samples.size() >= 318);
  CHECK(bench.samples.size() <= 322);
  CHECK(bench.largest_error_pa(96'000.0) < 0.3);  // one bit at 16 times is 0.2 Pa
  for (const PressureSample& sample : bench.samples) {
    CHECK(sample.temperature_c == doctest::Approx(21.0).epsilon(1e-4));
    CHECK(sample.variance_pa2 == doctest::Approx(0.35 * 0.35));
  }
  CHECK(bench.steps < 1400);  // 128 polls a second: the processor sleeps between them
  CHECK(bench.fault().empty());
  CHECK(bench.sensor.place() == "DPS310 on /dev/i2c-1 at 0x77");
}

TEST_CASE("a sample's stamp is the time of its pressure, to half a poll") {
  for (const Settings& settings :
       {with_rates(32, 16, 4, 8), with_rates(8, 64, 1, 1), with_rates(128, 2, 8, 1)}) {
    Bench bench(settings);
    // 8 m/s of climb; 80 Pa/s times half of the slowest poll, 20 ms, is 0.8 Pa.
    const double t0_s = static_cast<double>(bench.chip.now_ns()) * 1e-9;
    bench.chip.pressure_pa = [t0_s](double t_s) { return 100'000.0 - 80.0 * (t_s - t0_s); };
    bench.run(5.0);
    REQUIRE(bench.samples.size() > 35);
    double sum = 0.0;
    for (const PressureSample& sample : bench.samples) {
      const double truth_pa = bench.chip.pressure_pa(static_cast<double>(sample.stamp_ns) * 1e-9);
      CHECK(std::abs(sample.pressure_pa - truth_pa) < 1.2);
      sum += sample.pressure_pa - truth_pa;
    }
    // 3 ms of mean error in time are 2 cm at 8 m/s.
    CHECK(std::abs(sum / static_cast<double>(bench.samples.size())) < 0.75);
  }
}

TEST_CASE("every rate and oversampling that fit into a second give correct values at the rate") {
  for (int rate_hz = 1; rate_hz <= 128; rate_hz *= 2) {
    for (int times = 1; times <= 128; times *= 2) {
      const Settings settings = with_rates(rate_hz, times, std::min(rate_hz, 4), std::min(times, 16));
      if (busy_time_s(settings) >= 1.0) continue;
      CAPTURE(rate_hz);
      CAPTURE(times);
      Bench bench(settings);
      bench.run(1.0);
      bench.samples.clear();
      bench.run(6.0);
      CHECK(static_cast<double>(bench.samples.size()) >= 6.0 * rate_hz * 0.98 - 1.0);
      CHECK(static_cast<double>(bench.samples.size()) <= 6.0 * rate_hz + 1.0);
      CHECK(bench.largest_error_pa(96'000.0) < 0.3);
      CHECK((bench.chip.held(kConfig) & 0xF3) == 0);  // no FIFO, no interrupt, I2C
    }
  }
}

TEST_CASE("coefficients are read only after the chip reports them ready") {
  Bench slow;
  slow.chip.coefficients_ready_ns = 90'000'000;  // twice what the data sheet allows
  slow.run(1.0);
  CHECK(slow.samples.size() > 10);
  CHECK(slow.largest_error_pa(96'000.0) < 0.3);

  Bench never;
  never.chip.coefficients_ready_ns = std::int64_t{1} << 60;
  never.run(20.0);
  CHECK(never.samples.empty());
  CHECK(never.sensor.status().state == DeviceState::kWrongDevice);
  CHECK(never.fault() == "sensor or coefficients not ready 0.1 s after a reset");
  CHECK(never.sensor.status().counters.starts < 12);  // the wait doubles each time
}

TEST_CASE("chips that need the erratum sequence, and either thermometer, read the room's temperature") {
  for (const bool external : {true, false}) {
    for (const bool hot : {true, false}) {
      Bench bench;
      bench.chip.external_thermometer = external;
      bench.chip.hot_until_corrected = hot;
      bench.run(3.0);
      REQUIRE(bench.samples.size() > 50);
      CHECK(bench.samples.back().temperature_c == doctest::Approx(21.0).epsilon(1e-3));
      CHECK(std::abs(bench.samples.back().pressure_pa - 96'000.0) < 0.3);
    }
  }
}

TEST_CASE(
    "an unplugged sensor is flagged within 0.5 s, retried at growing intervals, and used once it is back") {
  Bench bench;
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
  CHECK(bench.largest_error_pa(96'000.0) < 0.3);
}

TEST_CASE("a bus that loses one transaction in a hundred loses samples, but the sensor keeps measuring") {
  Bench bench;
  bench.run(1.0);
  bench.chip.nak_share = 0.01;
  bench.samples.clear();
  bench.run(100.0);
  CHECK(bench.samples.size() > 3'150);
  CHECK(bench.sensor.status().counters.starts == 1);
  CHECK(bench.sensor.status().counters.io_errors > 50);
}

TEST_CASE("a sensor that answers without new results is reported within 0.5 s and reset") {
  Bench bench;
  bench.run(2.0);
  bench.chip.stops = true;
  CHECK(bench.time_until(DeviceState::kSilent, 3.0) < 0.5);
  CHECK(bench.fault() == "no new result");
  bench.run(1.0);
  CHECK(bench.chip.soft_resets > 1);
  bench.chip.stops = false;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.5);
  CHECK(bench.sensor.status().counters.silent >= 1);
}

TEST_CASE("a thermometer without new results is a fault: every pressure needs its temperature") {
  Bench bench;
  bench.run(2.0);
  bench.chip.thermometer_stops = true;
  CHECK(bench.time_until(DeviceState::kSilent, 5.0) < 1.5);  // 3 measurements at 4 Hz, and silence
  CHECK(bench.fault().find("temperature") != std::string::npos);
}

TEST_CASE("a sensor whose bits freeze is reported within 2 s and gives no sample until they change again") {
  Bench bench({}, kStuckNs);
  bench.chip.noise_pa = 0.35;
  bench.run(3.0);
  bench.chip.frozen = true;
  CHECK(bench.time_until(DeviceState::kStuck, 5.0) < 2.0);
  const std::size_t samples = bench.samples.size();
  bench.run(20.0);
  CHECK(bench.samples.size() == samples);
  CHECK(bench.sensor.status().state == DeviceState::kStuck);
  CHECK(bench.sensor.status().counters.stuck == 1);
  bench.chip.frozen = false;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.5);
}

TEST_CASE("implausible values are refused, counted and reported within 0.5 s; good values clear the fault") {
  Bench bench;
  bench.run(2.0);
  const std::size_t good = bench.samples.size();
  bench.chip.temperature_c = 95.0;
  bench.run(0.3);  // the next temperature
  const std::size_t before = bench.samples.size();
  CHECK(bench.time_until(DeviceState::kImplausible, 3.0) < 0.5);
  CHECK(bench.fault() == "temperature outside -40 ... 85 degrees C");
  CHECK(bench.samples.size() == before);
  CHECK(before < good + 12);
  CHECK(bench.sensor.status().counters.implausible > 5);
  bench.chip.temperature_c = 21.0;
  CHECK(bench.time_until(DeviceState::kMeasuring, 10.0) < 5.5);
}

TEST_CASE("noise of the data sheet never counts as a frozen sensor") {
  for (const Settings& settings :
       {with_rates(32, 16, 4, 8), with_rates(8, 64, 1, 1), with_rates(64, 8, 4, 1)}) {
    Bench bench(settings, kStuckNs);
    bench.chip.noise_pa = pressure_noise_pa(settings.pressure_oversampling);
    bench.run(600.0);
    CHECK(bench.sensor.status().counters.stuck == 0);
    CHECK(bench.sensor.status().counters.starts == 1);
  }
}

TEST_CASE(
    "a brown-out is detected by the lost settings and recovered in half a second, without a wrong sample") {
  Bench bench;
  bench.run(2.0);
  for (int i = 0; i < 20; ++i) {
    bench.chip.power_up();
    bench.run(0.05);
    CHECK(bench.time_until(DeviceState::kMeasuring, 3.0) < 0.45);
    bench.run(3.0 + 0.0037 * i);  // each time in another phase of the measurement
  }
  CHECK(bench.sensor.status().counters.resets == 20);
  CHECK(bench.largest_error_pa(96'000.0) < 0.3);
}

TEST_CASE("another device at the address is reported, and nothing is written to it") {
  Bench other;
  other.chip.id = 0x58;
  other.run(1.0);
  CHECK(other.sensor.status().state == DeviceState::kWrongDevice);
  CHECK(other.fault() == "the product id is not 0x10: another device");
  CHECK(other.chip.soft_resets == 0);
}

TEST_CASE("a bus that cannot be opened is reported with the reason") {
  ChipModel chip;
  auto bus = std::make_unique<ModelBus>(chip);
  ModelBus& model = *bus;
  Sensor sensor({}, std::move(bus), kStuckNs);
  const auto words_for = [&](int error) {
    model.open_error = error;
    (void)sensor.step(chip.now_ns());
    return std::string(sensor.status().fault.data());
  };
  CHECK(words_for(ENOENT) == "the bus cannot be opened (No such file or directory)");
  CHECK(words_for(EACCES) == "the bus cannot be opened (Permission denied)");
  CHECK(words_for(EBUSY) == "a kernel driver holds the device (Device or resource busy)");
  CHECK(words_for(ENOTSUP) == "the bus has no SMBus byte reads and writes (Operation not supported)");
}

TEST_CASE(
    "a slow bus on a busy machine meets updates in the middle of a read, and no sample mixes two results") {
  Bench bench(with_rates(64, 4, 8, 1));
  bench.late_ns = 20'000'000;
  bench.chip.byte_time_ns = 400'000;  // a read of both results takes 3.6 ms, a measurement 8.4 ms
  bench.chip.pressure_pa = [](double t_s) { return 96'000.0 + 2'000.0 * std::sin(3.0 * t_s); };
  bench.run(60.0);
  REQUIRE(bench.samples.size() > 1'000);
  CHECK(bench.sensor.status().counters.torn > 50);
  // The raw pressures themselves are compared: 1 bit is 0.013 Pa at 4 times, and the temperature is constant.
  std::size_t invented = 0;
  for (const PressureSample& sample : bench.samples) {
    const auto matches = [&](std::int32_t raw) {
      const double ts = (sample.temperature_c - 110.0) / -293.0;
      const RawResult result{raw, static_cast<std::int32_t>(std::lround(ts * scale_factor(1)))};
      return std::abs(compensate(dps310::kKnownCoefficients, result, scale_factor(4), scale_factor(1))
                          .pressure_pa -
                      sample.pressure_pa) < 1e-6;
    };
    if (std::none_of(bench.chip.pressures.begin(), bench.chip.pressures.end(), matches)) ++invented;
  }
  CHECK(invented == 0);
}

TEST_CASE("a chip whose oscillator is 20 % slow still measures") {
  Bench bench;
  bench.chip.slow = 1.2;
  bench.run(10.0);
  CHECK(bench.samples.size() > 250);
  CHECK(bench.sensor.status().counters.starts == 1);
}

namespace {

/// Bus without a chip: the test supplies every read.
class FreeBus final : public RegisterBus {
 public:
  explicit FreeBus(std::function<std::uint8_t(std::uint8_t)> byte) : byte_(std::move(byte)) {}
  int open() noexcept override { return 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    for (std::uint8_t& byte : bytes) byte = byte_(first++);
    return 0;
  }
  int write(std::uint8_t, std::uint8_t) noexcept override { return 0; }

 private:
  std::function<std::uint8_t(std::uint8_t)> byte_;
};

/// Runs a driver on such a bus for a number of steps; returns its samples.
std::vector<PressureSample> run_free(Sensor& sensor, int steps) {
  std::vector<PressureSample> samples;
  std::int64_t now_ns = 1'000'000'000;
  for (int i = 0; i < steps; ++i) {
    const Device<PressureSample>::Step step = sensor.step(now_ns);
    REQUIRE(step.next_ns > now_ns);
    now_ns = step.next_ns;
    if (step.has_sample) samples.push_back(step.sample);
  }
  return samples;
}

}  // namespace

TEST_CASE("a bus held low or high is not a sensor and gives no sample") {
  for (const std::uint8_t level : {0x00, 0xFF}) {
    Sensor sensor({}, std::make_unique<FreeBus>([level](std::uint8_t) { return level; }), kStuckNs);
    CHECK(run_free(sensor, 200).empty());
    CHECK(sensor.status().state == DeviceState::kWrongDevice);
  }
}

TEST_CASE("for all bytes on the bus, every sample is finite and plausible") {
  std::mt19937 random(17);
  const auto any = [&random] { return static_cast<std::uint8_t>(random()); };
  std::uint64_t samples = 0;
  std::uint64_t implausible = 0;
  for (int run = 0; run < 300; ++run) {
    CoefficientBytes coefficients = dps310::kKnownBytes;
    for (int flips = run % 3; flips > 0; --flips) coefficients[any() % kCoefficientBytes] = any();
    std::array<std::uint8_t, kResultBytes> results{};
    std::array<std::uint8_t, 256> written{};
    // Status and settings read correctly, so that the driver proceeds to the results; one status in 50 is
    // random.
    const auto byte = [&](std::uint8_t address) -> std::uint8_t {
      if (address >= kCoefficients && address < kCoefficients + kCoefficientBytes) {
        return coefficients[address - kCoefficients];
      }
      switch (address) {
        case kProductId:
          return kDps310Id;
        case kMeasurementConfig:
          for (auto& b : results) b = any();
          return any() < 5 ? any() : std::uint8_t{0xF7};
        case kPressureConfig:
          return 0x54;
        case kTemperatureConfig:
          return 0x23;
        case kConfig:
          return kShiftPressure;
        case kCoefficientSource:
          return 0;
        default:
          return address < kResultBytes ? results[address] : written[address];
      }
    };
    Sensor sensor({}, std::make_unique<FreeBus>(byte), kStuckNs);
    for (const PressureSample& sample : run_free(sensor, 300)) {
      REQUIRE(sample.pressure_pa >= 30e3);
      REQUIRE(sample.pressure_pa <= 120e3);
      REQUIRE(sample.temperature_c >= -40.0);
      REQUIRE(sample.temperature_c <= 85.0);
      ++samples;
    }
    implausible += sensor.status().counters.implausible;
  }
  CHECK(samples > 100);  // enough results pass the checks
  CHECK(implausible > 1'000);
}

TEST_CASE("samples, faults and restarts allocate no memory") {
  // The chip works for 2000 accesses, is silent for 500, and works again.
  std::uint64_t accesses = 0;
  std::array<std::uint8_t, 3> written{0x54, 0x23, kShiftPressure};
  std::uint8_t count = 0;
  const auto byte = [&](std::uint8_t address) -> std::uint8_t {
    const bool silent = ++accesses % 2'500 > 2'000;
    if (address >= kCoefficients && address < kCoefficients + kCoefficientBytes) {
      return dps310::kKnownBytes[address - kCoefficients];
    }
    switch (address) {
      case kProductId:
        return kDps310Id;
      case kMeasurementConfig:
        ++count;
        return silent ? 0xC7 : 0xF7;
      case kPressureConfig:
      case kTemperatureConfig:
        return written[address - kPressureConfig];
      case kConfig:
        return written[2];
      case kPressureResult:
        return 0xFE;  // about 96 kPa
      case kPressureResult + 2:
        return count;  // changes with each read, so that it does not count as stuck
      case kTemperatureResult:
        return 0x20;
      default:
        return 0;
    }
  };
  Sensor sensor({}, std::make_unique<FreeBus>(byte), kStuckNs);
  std::int64_t now_ns = 1'000'000'000;
  const std::size_t before = isobar::test::allocation_count();
  for (int i = 0; i < 5'000; ++i) now_ns = sensor.step(now_ns).next_ns;
  CHECK(isobar::test::allocation_count() == before);
  CHECK(sensor.status().counters.samples > 100);
  CHECK(sensor.status().counters.silent > 0);
  CHECK(sensor.status().counters.starts > 1);
}

TEST_CASE("a missing bus, or a file that is not a bus, gives an errno and no crash") {
  SmbusDevice missing("/dev/i2c-no-such-bus", 0x77);
  CHECK(missing.open() == ENOENT);
  SmbusDevice none("/dev/null", 0x77);
  CHECK(none.open() == ENOTTY);
  std::uint8_t byte = 0;
  CHECK(none.read(kProductId, {&byte, 1}) == EBADF);
  CHECK(none.write(kReset, kSoftReset) == EBADF);
}

}  // namespace isobar::test::test_sensor
