// SPDX-License-Identifier: BSD-3-Clause
// The thread for a barometer attached to this machine, in real time on a model of a DPS310: samples in shared
// memory, faults in the health report.
#include "daemon/barometer_thread.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <tuple>

#include "daemon/health.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "drivers/dps310/sensor.hpp"
#include "tests/drivers/dps310/chip_model.hpp"
#include "tests/support/device_thread.hpp"

namespace isobar::test::test_barometer_thread {

using namespace std::chrono_literals;

namespace {

/// A chip model that runs in real time; the test changes it while the thread reads it.
struct LiveChip {
  LiveChip() { chip.noise_pa = 0.35; }
  void change(const std::function<void(dps310::ChipModel&)>& what) {
    const std::lock_guard lock(mutex);
    what(chip);
  }
  /// Advances the model to the present. Call under the lock.
  void catch_up() { chip.run_until(RobotClock::now_ns() - start_ns + 2'000'000'000'000); }

  std::mutex mutex;
  dps310::ChipModel chip;
  std::int64_t start_ns = RobotClock::now_ns();
};

class LiveBus final : public RegisterBus {
 public:
  explicit LiveBus(LiveChip& live) : live_(&live) {}
  int open() noexcept override { return 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    const std::lock_guard lock(live_->mutex);
    live_->catch_up();
    return live_->chip.read(first, bytes);
  }
  int write(std::uint8_t address, std::uint8_t value) noexcept override {
    const std::lock_guard lock(live_->mutex);
    live_->catch_up();
    return live_->chip.write(address, value);
  }

 private:
  LiveChip* live_;
};

/// The thread, a reader of its topic, and its entry in the health report.
struct Rig {
  Rig()
      : barometer(std::make_unique<dps310::Sensor>(dps310::Settings{}, std::make_unique<LiveBus>(live),
                                                   1'500'000'000),
                  ThreadSettings{"barometer", 0, {}}),
        reader(ipc::topics::kBarometer),
        waiter({&reader.raw()}),
        monitor(config()) {
    barometer.worker().start();
  }
  static Config config() {
    Config config;
    config.barometer.source = BarometerSource::kDps310;
    return config;
  }
  /// Number of samples received within `time`.
  int count(std::chrono::milliseconds time, PressureSample* last = nullptr) {
    const auto end = std::chrono::steady_clock::now() + time;
    int samples = 0;
    for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now()) {
      (void)waiter.wait_for(end - now);
      while (const auto sample = reader.take()) {
        ++samples;
        if (last != nullptr) *last = *sample;
      }
    }
    return samples;
  }
  /// The entry "barometer" of a report made now: level and message.
  std::pair<ipc::HealthLevel, std::string> health() {
    StatusSnapshot now;
    now.now_ns = RobotClock::now_ns();
    now.barometer = barometer.status();
    ipc::HealthReport report;
    monitor.fill(now, report);
    return entry_of(report, "barometer");
  }

  ipc::Broker broker;
  LiveChip live;
  BarometerThread barometer;
  ipc::Subscriber<PressureSample> reader;
  ipc::Waiter waiter;
  HealthMonitor monitor;
};

}  // namespace

TEST_CASE(
    "samples arrive at the sensor's rate; a fault is reported with its place, and only while it lasts") {
  Rig rig;
  rig.count(1'000ms);
  PressureSample last;
  const int samples = rig.count(2'000ms, &last);
  // 64 in 2 s; a busy machine may miss some.
  CHECK(samples >= 40);
  CHECK(samples <= 68);
  CHECK(std::abs(last.pressure_pa - 96'000.0) < 3.0);
  CHECK(last.variance_pa2 == doctest::Approx(0.35 * 0.35));
  const std::int64_t age_ns = RobotClock::now_ns() - last.stamp_ns;
  CHECK(age_ns > 0);
  CHECK(age_ns < 1'000'000'000);
  auto [level, words] = rig.health();
  CHECK(level == ipc::HealthLevel::kOk);
  CHECK(words.find("per second from DPS310 on /dev/i2c-1 at 0x77") != std::string::npos);

  rig.live.change([](auto& chip) { chip.unplugged = true; });
  rig.count(500ms);
  CHECK(rig.count(300ms) == 0);
  std::tie(level, words) = rig.health();
  CHECK(level == ipc::HealthLevel::kError);
  CHECK(words == "DPS310 on /dev/i2c-1 at 0x77: no answer (Remote I/O error)");

  rig.live.change([](auto& chip) {
    chip.unplugged = false;
    chip.power_up();
  });
  rig.count(2'500ms);
  CHECK(rig.count(1'000ms) > 15);
  CHECK(rig.health().first == ipc::HealthLevel::kOk);

  rig.live.change([](auto& chip) { chip.frozen = true; });
  rig.count(2'000ms);
  std::tie(level, words) = rig.health();
  CHECK(level == ipc::HealthLevel::kError);
  CHECK(words == "DPS310 on /dev/i2c-1 at 0x77: the result no longer changes");
}

TEST_CASE("a thread that waits five seconds before its next try stops at once") {
  Rig rig;
  rig.live.change([](auto& chip) { chip.unplugged = true; });
  rig.count(2'000ms);
  const auto before = std::chrono::steady_clock::now();
  rig.barometer.worker().stop();
  CHECK(std::chrono::steady_clock::now() - before < 1s);
}

}  // namespace isobar::test::test_barometer_thread
