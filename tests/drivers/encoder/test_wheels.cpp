// SPDX-License-Identifier: BSD-3-Clause
// The device on lines that a test turns.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <deque>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "drivers/encoder/gpio_lines.hpp"
#include "drivers/encoder/sensor.hpp"
#include "tests/drivers/encoder/turning_wheel.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_wheels {

using namespace isobar::encoder;
using isobar::encoder::TurningWheel;

namespace {

constexpr std::int64_t kMs = 1'000'000;
/// Robot clock minus clock of the edges.
constexpr std::int64_t kClocksApartNs = 1'700'000'000'000'000'000;

/// Lines with the kernel's queue of 16 edges each, turned by the test.
class ModelLines final : public EdgeSource {
 public:
  int open() noexcept override {
    ++opens;
    if (open_error == 0) is_open = true;
    return open_error;
  }
  void close() noexcept override { is_open = false; }
  int level(std::uint8_t encoder, Line line, bool& high) noexcept override {
    high = line == Line::kA ? wheels[encoder].a() : wheels[encoder].b();
    return 0;
  }
  int read(EdgeSorter& edges) noexcept override {
    if (read_error != 0) return read_error;
    for (auto& queue : queues) {
      if (queue.size() == 16) ++full;
      for (; !queue.empty(); queue.pop_front()) (void)edges.add(queue.front());
    }
    return 0;
  }
  [[nodiscard]] std::uint64_t full_queues() const noexcept override { return full; }
  [[nodiscard]] std::int64_t now_ns() const noexcept override { return time_ns; }
  [[nodiscard]] int file_descriptor() const noexcept override { return 42; }

  void turn(std::uint8_t wheel, bool forward) {
    const Edge edge = wheels[wheel].turn(forward, time_ns);
    auto& queue = queues[2U * wheel + static_cast<std::size_t>(edge.line)];
    if (!is_open) return;
    if (queue.size() < 16) {
      queue.push_back(edge);
    } else {
      ++dropped;
    }
  }

  std::array<TurningWheel, kMaxEncoders> wheels{TurningWheel(0), TurningWheel(1), TurningWheel(2),
                                                TurningWheel(3)};
  std::array<std::deque<Edge>, 2 * kMaxEncoders> queues;
  std::int64_t time_ns = 5'000 * kMs;
  bool is_open = false;
  int open_error = 0;
  int read_error = 0;
  int opens = 0;
  std::uint64_t dropped = 0;
  std::uint64_t full = 0;
};

Settings two_wheels() {
  Settings settings;
  settings.left = {17, 18};
  settings.right = {22, 23};
  return settings;
}

/// Lines, device and clock.
struct WheelBench {
  explicit WheelBench(const Settings& settings = two_wheels()) {
    auto made = std::make_unique<ModelLines>();
    lines = made.get();
    sensor = std::make_unique<Sensor>(settings, std::move(made));
  }
  /// Turns both wheels at constant rates [edges per second], stepping the device when edges come or it is
  /// due.
  void run(double seconds, double left_hz, double right_hz, std::int64_t read_every_ns = kMs) {
    const std::int64_t end_ns = lines->time_ns + static_cast<std::int64_t>(seconds * 1e9);
    std::int64_t read_ns = lines->time_ns;
    while (lines->time_ns < end_ns) {
      lines->time_ns += 10'000;
      const std::array rates{left_hz, right_hz};
      for (std::uint8_t wheel = 0; wheel < 2; ++wheel) {
        turned[wheel] += std::abs(rates[wheel]) * 1e-5;
        if (turned[wheel] < 1.0) continue;
        turned[wheel] -= 1.0;
        lines->turn(wheel, rates[wheel] > 0.0);
      }
      if (lines->time_ns - read_ns < read_every_ns) continue;
      read_ns = lines->time_ns;
      step();
    }
  }
  void step() {
    const std::int64_t now_ns = lines->time_ns + kClocksApartNs;
    const Device<WheelSample>::Step step = sensor->step(now_ns);
    next_ns = step.next_ns;
    if (step.has_sample) samples.push_back(step.sample);
  }

  ModelLines* lines = nullptr;
  std::unique_ptr<Sensor> sensor;
  std::array<double, 2> turned{};
  std::int64_t next_ns = 0;
  std::vector<WheelSample> samples;
};

constexpr double kCountM = 0.2 * std::numbers::pi / 2'000.0;

}  // namespace

TEST_CASE("turning wheels give the twist at the rate, stamped with the middle of each period") {
  WheelBench bench;
  bench.run(2.0, 1'000.0, 2'000.0);
  CHECK(bench.samples.size() >= 98);
  CHECK(bench.samples.size() <= 100);
  const WheelSample& sample = bench.samples.back();
  CHECK(sample.vx_m_s == doctest::Approx(1'500.0 * kCountM).epsilon(0.05));
  CHECK(sample.wz_rad_s == doctest::Approx(1'000.0 * kCountM / 0.5).epsilon(0.1));
  for (std::size_t i = 1; i < bench.samples.size(); ++i) {
    CHECK(bench.samples[i].stamp_ns - bench.samples[i - 1].stamp_ns == 20 * kMs);
  }
  const std::int64_t age_ns = bench.lines->time_ns + kClocksApartNs - sample.stamp_ns;
  CHECK(age_ns >= 10 * kMs);
  CHECK(age_ns <= 32 * kMs);
  CHECK(bench.sensor->place() == "encoders on /dev/gpiochip0");
}

TEST_CASE(
    "20 kHz of edges on four lines, read every 3 ms, are counted exactly, and none is lost in the samples") {
  WheelBench bench;
  bench.step();
  bench.run(20.0, 10'000.0, -10'000.0, 3 * kMs);
  bench.run(0.1, 0.0, 0.0);
  CHECK(bench.lines->dropped == 0);
  CHECK(bench.sensor->count(0) == bench.lines->wheels[0].position());
  CHECK(bench.sensor->count(1) == bench.lines->wheels[1].position());
  CHECK(bench.lines->wheels[0].position() > 199'000);
  double turned_rad = 0.0;
  for (const WheelSample& sample : bench.samples) turned_rad += sample.wz_rad_s * 0.02;
  const auto difference =
      static_cast<double>(bench.lines->wheels[1].position() - bench.lines->wheels[0].position());
  CHECK(turned_rad == doctest::Approx(difference * kCountM / 0.5).epsilon(1e-9));
  CHECK(bench.sensor->status().counters.corrupt == 0);
}

TEST_CASE("edges that the kernel dropped are counted") {
  WheelBench bench;
  bench.step();
  bench.run(5.0, 5'000.0, 5'000.0, 8 * kMs);  // 20 edges a line between two reads
  CHECK(bench.lines->dropped > 1'000);
  CHECK(bench.sensor->status().counters.corrupt > 100);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
}

TEST_CASE("standing wheels are zeros at the rate, not silence") {
  WheelBench bench;
  bench.run(5.0, 0.0, 0.0);
  CHECK(bench.samples.size() > 240);
  CHECK(bench.samples.back().vx_m_s == 0.0);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
}

TEST_CASE(
    "while edges come they are read every half millisecond; wheels that stand wake only at a period's end") {
  WheelBench bench;
  bench.run(0.1, 5'000.0, 5'000.0);
  CHECK(bench.sensor->file_descriptor() == -1);
  CHECK(bench.next_ns - (bench.lines->time_ns + kClocksApartNs) <= Sensor::kReadEveryNs);
  bench.run(0.1, 0.0, 0.0);
  CHECK(bench.sensor->file_descriptor() == 42);
  bench.run(0.005, 0.0, 0.0);
  CHECK(bench.next_ns - (bench.lines->time_ns + kClocksApartNs) > 5 * kMs);
}

TEST_CASE("a late call gives the samples of all periods that have ended, with the edges in their periods") {
  WheelBench bench;
  bench.run(0.5, 400.0, 400.0);
  bench.samples.clear();
  bench.run(0.05, 400.0, 400.0, 50 * kMs);
  while (bench.next_ns <= bench.lines->time_ns + kClocksApartNs) bench.step();
  CHECK(bench.samples.size() >= 2);
  for (const WheelSample& sample : bench.samples) {
    CHECK(sample.vx_m_s == doctest::Approx(400.0 * kCountM).epsilon(0.15));  // 8 edges a period
  }
}

TEST_CASE("lines that cannot be requested are reported with the reason and tried again") {
  WheelBench bench;
  bench.lines->open_error = EBUSY;
  bench.run(1.0, 0.0, 0.0, 100 * kMs);
  CHECK(bench.samples.empty());
  CHECK(std::string(bench.sensor->status().fault.data()) ==
        "another program holds a line (Device or resource busy)");
  CHECK(bench.sensor->file_descriptor() == -1);
  bench.lines->open_error = 0;
  bench.run(5.0, 0.0, 0.0, 100 * kMs);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
}

TEST_CASE("a chip that goes away is reported at once, and after its return the count goes on") {
  WheelBench bench;
  bench.run(1.0, 1'000.0, 1'000.0);
  bench.lines->read_error = ENODEV;
  bench.run(0.01, 1'000.0, 1'000.0);
  CHECK(bench.sensor->status().state == DeviceState::kNoAnswer);
  const std::int64_t count = bench.sensor->count(0);
  bench.lines->read_error = 0;
  bench.run(1.0, 1'000.0, 1'000.0, 100 * kMs);
  bench.samples.clear();
  bench.run(1.0, 1'000.0, 1'000.0);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
  CHECK(bench.sensor->count(0) > count + 900);
  CHECK(bench.samples.back().vx_m_s == doctest::Approx(1'000.0 * kCountM).epsilon(0.1));
}

TEST_CASE("a speed that no robot drives is refused and said") {
  Settings settings = two_wheels();
  settings.geometry.counts_per_turn = 20.0;
  WheelBench bench(settings);
  bench.run(1.0, 2'000.0, 2'000.0);  // 63 m/s
  CHECK(bench.samples.empty());
  CHECK(bench.sensor->status().state == DeviceState::kImplausible);
  CHECK(bench.sensor->status().counters.implausible > 20);
  bench.run(1.0, 100.0, 100.0);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
}

TEST_CASE("of two wheels on a side the mean counts") {
  Settings settings = two_wheels();
  settings.rear_left = {5, 6};
  WheelBench bench(settings);
  bench.run(1.0, 1'000.0, 1'000.0);
  // The rear left wheel stands: the left side has half of the speed.
  CHECK(bench.samples.back().vx_m_s == doctest::Approx(750.0 * kCountM).epsilon(0.05));
}

TEST_CASE("reading and samples allocate no memory") {
  WheelBench bench;
  bench.run(0.5, 5'000.0, 5'000.0);
  std::size_t allocated = 0;
  for (int i = 0; i < 200; ++i) {
    for (int edge = 0; edge < 10; ++edge) {
      bench.lines->time_ns += 100'000;
      bench.lines->turn(0, true);
    }
    const std::size_t before = allocation_count();
    (void)bench.sensor->step(bench.lines->time_ns + kClocksApartNs);
    allocated += allocation_count() - before;
  }
  CHECK(allocated == 0);
}

TEST_CASE("a chip that is none gives an errno and no crash") {
  Settings settings = two_wheels();
  settings.chip = "/dev/gpiochip-no-such";
  GpioLines missing(settings);
  CHECK(missing.open() == ENOENT);
  CHECK(missing.file_descriptor() == -1);
  settings.chip = "/dev/null";
  GpioLines none(settings);
  CHECK(none.open() != 0);
  bool high = false;
  CHECK(none.level(0, Line::kA, high) == EBADF);
  EdgeSorter edges;
  CHECK(none.read(edges) == EBADF);
  CHECK(edges.size() == 0);
  CHECK(none.now_ns() > 0);
}

}  // namespace isobar::test::test_wheels
