// SPDX-License-Identifier: BSD-3-Clause
// Every barometer on a bus without a chip: levels, noise, silence.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <span>

#include "tests/drivers/barometer/sensors.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_any_bytes {

namespace {

/// Bus without a chip: the test supplies every byte read.
class FreeBus final : public RegisterBus {
 public:
  explicit FreeBus(std::function<std::uint8_t(std::uint8_t)> byte) : byte_(std::move(byte)) {}
  int open() noexcept override { return 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    for (std::uint8_t& byte : bytes) byte = byte_(first++);
    return 0;
  }
  int write(std::uint8_t, std::uint8_t) noexcept override { return 0; }
  int command(std::uint8_t) noexcept override { return 0; }

 private:
  std::function<std::uint8_t(std::uint8_t)> byte_;
};

/// A sound chip whose bytes arrive wrong now and then.
class FlippingBus final : public RegisterBus {
 public:
  explicit FlippingBus(BarometerModel& chip) : bus_(chip) {}
  int open() noexcept override { return 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    const int error = bus_.read(first, bytes);
    for (std::uint8_t& byte : bytes) {
      if (random_() % 50 == 0) byte = static_cast<std::uint8_t>(random_());
    }
    return error;
  }
  int write(std::uint8_t address, std::uint8_t value) noexcept override { return bus_.write(address, value); }
  int command(std::uint8_t code) noexcept override { return bus_.command(code); }

 private:
  BarometerBus bus_;
  std::mt19937 random_{17};
};

/// Counts the allocations of the model, which are not the driver's.
class CountedBus final : public RegisterBus {
 public:
  CountedBus(BarometerModel& chip, std::size_t& inside) : bus_(chip), inside_(&inside) {}
  int open() noexcept override { return 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    return counted([&] { return bus_.read(first, bytes); });
  }
  int write(std::uint8_t address, std::uint8_t value) noexcept override {
    return counted([&] { return bus_.write(address, value); });
  }
  int command(std::uint8_t code) noexcept override {
    return counted([&] { return bus_.command(code); });
  }

 private:
  template <class Access>
  int counted(const Access& access) {
    const std::size_t before = allocation_count();
    const int error = access();
    *inside_ += allocation_count() - before;
    return error;
  }
  BarometerBus bus_;
  std::size_t* inside_;
};

}  // namespace

TEST_CASE_TEMPLATE("a bus held low or high is not a sensor and gives no sample", T, Bmp581, Bmp390, Icp20100,
                   Ms5611) {
  for (const std::uint8_t level : {0x00, 0xFF}) {
    typename T::Sensor sensor({}, std::make_unique<FreeBus>([level](std::uint8_t) { return level; }), 0);
    std::int64_t now_ns = 1'000'000'000;
    for (int i = 0; i < 200; ++i) {
      const Device<PressureSample>::Step step = sensor.step(now_ns);
      REQUIRE(step.next_ns > now_ns);
      CHECK_FALSE(step.has_sample);
      now_ns = step.next_ns;
    }
    CHECK(sensor.status().state == DeviceState::kWrongDevice);
  }
}

TEST_CASE_TEMPLATE("for any bytes flipped on the bus, every sample is plausible and every step lies ahead", T,
                   Bmp581, Bmp390, Icp20100, Ms5611) {
  typename T::Bench bench;  // its chip; the driver is one of its own
  typename T::Sensor sensor({}, std::make_unique<FlippingBus>(bench.chip), 0);
  std::uint64_t samples = 0;
  std::int64_t now_ns = bench.chip.now_ns();
  for (int i = 0; i < 50'000; ++i) {
    const Device<PressureSample>::Step step = sensor.step(now_ns);
    REQUIRE(step.next_ns > now_ns);
    REQUIRE(step.next_ns - now_ns < 5'000'000'000);
    now_ns = std::max(step.next_ns, bench.chip.now_ns());
    bench.chip.run_until(now_ns);
    if (!step.has_sample) continue;
    ++samples;
    REQUIRE(step.sample.pressure_pa >= 30e3);
    REQUIRE(step.sample.pressure_pa <= 120e3);
    REQUIRE(step.sample.temperature_c >= -40.0);
    REQUIRE(step.sample.temperature_c <= 85.0);
  }
  CHECK(samples > 500);
  CHECK(sensor.status().counters.starts > 1);
}

TEST_CASE_TEMPLATE("samples, faults and restarts allocate no memory", T, Bmp581, Bmp390, Icp20100, Ms5611) {
  typename T::Bench bench;
  bench.run(2.0);
  std::size_t allocated = 0;
  std::int64_t now_ns = bench.chip.now_ns();
  std::size_t inside = 0;
  typename T::Sensor sensor({}, std::make_unique<CountedBus>(bench.chip, inside), 0);
  for (int i = 0; i < 10'000; ++i) {
    bench.chip.unplugged = i % 2'500 > 2'000;
    bench.chip.stops = i % 2'500 < 200;
    const std::size_t before = allocation_count();
    inside = 0;
    now_ns = std::max(sensor.step(now_ns).next_ns, bench.chip.now_ns());
    allocated += allocation_count() - before - inside;
    bench.chip.run_until(now_ns);
  }
  CHECK(allocated == 0);
  CHECK(sensor.status().counters.samples > 100);
  CHECK(sensor.status().counters.silent > 0);
  CHECK(sensor.status().counters.starts > 2);
}

}  // namespace isobar::test::test_any_bytes
