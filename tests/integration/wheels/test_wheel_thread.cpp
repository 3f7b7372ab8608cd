// SPDX-License-Identifier: BSD-3-Clause
// The thread for encoders attached to this machine, in real time on lines that turn with the clock: samples in
// shared memory, lost edges and faults in the health report.
#include "daemon/wheel_thread.hpp"

#include <doctest/doctest.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "daemon/health.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "drivers/encoder/sensor.hpp"
#include "tests/drivers/encoder/turning_wheel.hpp"
#include "tests/support/device_thread.hpp"

namespace isobar::test::test_wheel_thread {

using namespace std::chrono_literals;
using encoder::Edge;
using encoder::EdgeSorter;
using encoder::Line;
using encoder::TurningWheel;

namespace {

std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// What the test sets while the thread reads.
struct Turning {
  std::atomic<double> left_hz = 0.0;  ///< counts per second, forward positive
  std::atomic<double> right_hz = 0.0;
  std::atomic<bool> plugged = true;
  std::atomic<bool> loses = false;  ///< every tenth edge
};

/// Two encoders whose edges come into being when they are read, with the stamps at which they occurred. A timer
/// makes the descriptor readable every millisecond.
class LiveLines final : public encoder::EdgeSource {
 public:
  explicit LiveLines(Turning& turning) : turning_(&turning) {}
  ~LiveLines() override { close(); }
  int open() noexcept override {
    close();
    if (!turning_->plugged) return ENOENT;
    timer_ = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
    const itimerspec every_ms{{0, 1'000'000}, {0, 1'000'000}};
    if (timer_ < 0 || timerfd_settime(timer_, 0, &every_ms, nullptr) != 0) return errno;
    read_ns_ = steady_ns();
    return 0;
  }
  void close() noexcept override {
    if (timer_ >= 0) ::close(timer_);
    timer_ = -1;
  }
  int level(std::uint8_t encoder, Line line, bool& high) noexcept override {
    high = line == Line::kA ? wheels_.at(encoder).a() : wheels_.at(encoder).b();
    return 0;
  }
  int read(EdgeSorter& edges) noexcept override {
    if (!turning_->plugged) return ENODEV;
    std::uint64_t expired = 0;
    (void)!::read(timer_, &expired, sizeof expired);
    // After a pause of a busy machine the wheels catch up step by step: lost edges are another test's.
    constexpr std::int64_t kMostNs = 10'000'000;
    const std::int64_t now = std::min(steady_ns(), read_ns_ + kMostNs);
    for (std::uint8_t wheel = 0; wheel < 2; ++wheel) {
      turn(wheel, wheel == 0 ? turning_->left_hz : turning_->right_hz, now, edges);
    }
    read_ns_ = now;
    return 0;
  }
  [[nodiscard]] std::uint64_t full_queues() const noexcept override { return 0; }
  [[nodiscard]] std::int64_t now_ns() const noexcept override { return steady_ns(); }
  [[nodiscard]] int file_descriptor() const noexcept override { return timer_; }

 private:
  void turn(std::uint8_t wheel, double rate_hz, std::int64_t now, EdgeSorter& edges) {
    const double before = turned_.at(wheel);
    const double after = before + std::abs(rate_hz) * 1e-9 * static_cast<double>(now - read_ns_);
    for (auto count = static_cast<int>(before) + 1; count <= after; ++count) {
      const auto since_ns = static_cast<std::int64_t>((count - before) / std::abs(rate_hz) * 1e9);
      const Edge edge = wheels_.at(wheel).turn(rate_hz > 0.0, read_ns_ + since_ns);
      if (!turning_->loses || ++edges_ % 10 != 0) (void)edges.add(edge);
    }
    turned_.at(wheel) = after;
  }

  Turning* turning_;
  std::array<TurningWheel, 2> wheels_{TurningWheel(0), TurningWheel(1)};
  std::array<double, 2> turned_{};
  std::int64_t read_ns_ = 0;
  std::uint64_t edges_ = 0;
  int timer_ = -1;
};

Config config_of() {
  Config config;
  config.wheel.source = WheelSource::kEncoder;
  config.wheel.encoder.left = {17, 18};
  config.wheel.encoder.right = {22, 23};
  return config;
}

/// The thread, a reader of its topic, and its entries in the health report.
struct Rig {
  Rig()
      : wheels(std::make_unique<encoder::Sensor>(config_of().wheel.encoder,
                                                 std::make_unique<LiveLines>(turning)),
               ThreadSettings{"wheels", 0, {}}) {
    wheels.worker().start();
  }
  /// Number of samples received within `time`; `sum` is that of their twists.
  int count(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    int samples = 0;
    sum = {};
    for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now()) {
      (void)waiter.wait_for(end - now);
      while (const auto sample = reader.take()) {
        ++samples;
        last = *sample;
        sum.vx_m_s += sample->vx_m_s;
        sum.wz_rad_s += sample->wz_rad_s;
      }
    }
    return samples;
  }
  /// Waits for a state; the time that it took [ms].
  double wait_for(DeviceState state) { return wait_for_state(wheels, state, 10s); }
  /// An entry of a report made now: level and message.
  std::pair<ipc::HealthLevel, std::string> health(const std::string& name) {
    StatusSnapshot now;
    now.now_ns = RobotClock::now_ns();
    now.wheels = wheels.status();
    ipc::HealthReport report;
    monitor.fill(now, report);
    return entry_of(report, name);
  }

  ipc::Broker broker;
  Turning turning;
  WheelThread wheels;
  ipc::Subscriber<WheelSample> reader{ipc::topics::kWheel};
  ipc::Waiter waiter = ipc::Waiter({&reader.raw()});
  HealthMonitor monitor{config_of()};
  WheelSample last;
  WheelSample sum;
};

constexpr double kCountM = 0.2 * std::numbers::pi / 2'000.0;  // of encoder::Geometry's defaults
constexpr double kTrackM = 0.5;

}  // namespace

TEST_CASE("turning wheels are twists at the rate, on the robot clock, and a fault is said with its place") {
  Rig rig;
  CHECK(rig.wait_for(DeviceState::kMeasuring) < 5'000.0);
  rig.turning.left_hz = 2'000.0;
  rig.turning.right_hz = 3'000.0;
  rig.count(200ms);
  const int samples = rig.count(1'000ms);
  // 50 in 1 s; a busy machine may miss some.
  CHECK(samples >= 40);
  CHECK(samples <= 55);
  // 40 and 60 counts a sample; where a period cuts, one count more or less in all samples together.
  CHECK(rig.sum.vx_m_s / samples == doctest::Approx(2'500.0 * kCountM).epsilon(0.01));
  CHECK(rig.sum.wz_rad_s / samples == doctest::Approx(1'000.0 * kCountM / kTrackM).epsilon(0.02));
  CHECK(rig.last.path == SamplePath::kLocal);
  const std::int64_t age_ns = RobotClock::now_ns() - rig.last.stamp_ns;
  CHECK(age_ns > 0);
  CHECK(age_ns < 500'000'000);
  auto [level, words] = rig.health("wheels");
  CHECK(level == ipc::HealthLevel::kOk);
  CHECK(words.ends_with("per second from encoders on /dev/gpiochip0"));
  CHECK(rig.health("wheels/lost_edges").second == "no entry");

  rig.turning.plugged = false;
  CHECK(rig.wait_for(DeviceState::kNoAnswer) < 200.0);
  std::tie(level, words) = rig.health("wheels");
  CHECK(level == ipc::HealthLevel::kError);
  CHECK(words.starts_with("encoders on /dev/gpiochip0: "));
  CHECK(words.ends_with("(No such device)"));
  rig.turning.plugged = true;
  CHECK(rig.wait_for(DeviceState::kMeasuring) < 2'000.0);
  CHECK(rig.count(500ms) > 10);
  CHECK(rig.health("wheels").first == ipc::HealthLevel::kOk);
}

TEST_CASE("lost edges are counted and said, the speed stays; the thread stops at once") {
  Rig rig;
  CHECK(rig.wait_for(DeviceState::kMeasuring) < 5'000.0);
  rig.turning.loses = true;
  rig.turning.left_hz = rig.turning.right_hz = 2'000.0;
  rig.count(200ms);
  const int samples = rig.count(1'000ms);
  CHECK(samples >= 40);
  // Every tenth edge of 4000 in a second; the decoder notices most and restores them.
  CHECK(rig.wheels.status().device.counters.corrupt > 200);
  CHECK(rig.sum.vx_m_s / samples == doctest::Approx(2'000.0 * kCountM).epsilon(0.1));
  CHECK(rig.health("wheels").first == ipc::HealthLevel::kOk);
  const auto [level, words] = rig.health("wheels/lost_edges");
  CHECK(level != ipc::HealthLevel::kStale);
  CHECK(words.starts_with("edges of encoders lost"));
  const auto before = std::chrono::steady_clock::now();
  rig.wheels.worker().stop();
  CHECK(std::chrono::steady_clock::now() - before < 1s);
}

}  // namespace isobar::test::test_wheel_thread
