// SPDX-License-Identifier: BSD-3-Clause
// The thread for an IMU attached to this machine, in real time on a simulated VN-100: samples in shared memory,
// faults in the health report.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <tuple>

#include "daemon/health.hpp"
#include "daemon/imu_thread.hpp"
#include "drivers/vn100/sensor.hpp"
#include "tests/drivers/vn100/simulated_vn100.hpp"
#include "tests/support/device_thread.hpp"

namespace isobar::test::test_imu_thread {

using namespace std::chrono_literals;

namespace {

/// The sensor's side, in a thread of its own.
class LiveSensor {
 public:
  LiveSensor() : thread_([this] { serve(); }) {}
  ~LiveSensor() {
    stop_ = true;
    thread_.join();
  }
  LiveSensor(const LiveSensor&) = delete;
  LiveSensor& operator=(const LiveSensor&) = delete;

  [[nodiscard]] std::string path() const { return sensor_.terminal.path(); }
  void set_plugged(bool plugged) {
    plugged_ = plugged;
    while (is_plugged_ != plugged) std::this_thread::sleep_for(1ms);
  }

 private:
  void serve() {
    while (!stop_) {
      if (plugged_ != sensor_.terminal.plugged())
        plugged_ ? sensor_.terminal.plug() : sensor_.terminal.unplug();
      is_plugged_ = sensor_.terminal.plugged();
      sensor_.serve(monotonic_ns());
      std::this_thread::sleep_for(1ms);
    }
  }

  SimulatedVn100 sensor_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> plugged_ = true;
  std::atomic<bool> is_plugged_ = true;
  std::thread thread_;
};

Config config_of(const LiveSensor& sensor) {
  Config config;
  config.imu.source = ImuSource::kVn100;
  config.imu.vn100.port = sensor.path();
  config.barometer.source = BarometerSource::kImu;
  return config;
}

/// The thread, readers of its topics, and its entries in the health report.
struct Rig {
  explicit Rig(bool with_pressure = true)
      : imu(vn100::make_sensor(config_of(sensor).imu.vn100), with_pressure, ThreadSettings{"imu", 0, {}}),
        monitor(config_of(sensor)) {
    imu.worker().start();
  }
  /// Number of samples received within `time`.
  int count(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    int samples = 0;
    for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now()) {
      (void)waiter.wait_for(end - now);
      while (const auto sample = reader.take()) {
        ++samples;
        last = *sample;
      }
      while (barometer.take()) ++pressures;
    }
    return samples;
  }
  /// Waits for a state; the time that it took [ms].
  double wait_for(DeviceState state) { return wait_for_state(imu, state, 5s); }
  /// An entry of a report made now: level and message.
  std::pair<ipc::HealthLevel, std::string> health(const std::string& name) {
    StatusSnapshot now;
    now.now_ns = RobotClock::now_ns();
    now.imu = imu.status();
    ipc::HealthReport report;
    monitor.fill(now, report);
    return entry_of(report, name);
  }

  ipc::Broker broker;
  LiveSensor sensor;
  ImuThread imu;
  ipc::Subscriber<ImuSample> reader{ipc::topics::kImu};
  ipc::Subscriber<PressureSample> barometer{ipc::topics::kBarometer};
  ipc::Waiter waiter = ipc::Waiter({&reader.raw()});
  HealthMonitor monitor;
  ImuSample last;
  int pressures = 0;
};

}  // namespace

TEST_CASE(
    "samples and pressures arrive at the sensor's rate; unplugged is said in 0.2 s, and 2 s suffice to "
    "return") {
  Rig rig;
  rig.wait_for(DeviceState::kMeasuring);
  const int samples = rig.count(1'000ms);
  // 200 in 1 s; a busy machine may miss some.
  CHECK(samples >= 150);
  CHECK(samples <= 210);
  CHECK(rig.pressures >= 5);
  CHECK(rig.last.accel_m_s2.z() == doctest::Approx(-9.8));
  const std::int64_t age_ns = RobotClock::now_ns() - rig.last.stamp_ns;
  CHECK(age_ns > 0);
  CHECK(age_ns < 500'000'000);
  auto [level, words] = rig.health("imu");
  CHECK(level == ipc::HealthLevel::kOk);
  CHECK(words.find("per second from VN-100 on " + rig.sensor.path()) != std::string::npos);
  CHECK(rig.health("imu/note").second.find("low-latency") != std::string::npos);

  rig.sensor.set_plugged(false);
  CHECK(rig.wait_for(DeviceState::kNoAnswer) < 200.0);
  std::tie(level, words) = rig.health("imu");
  CHECK(level == ipc::HealthLevel::kError);
  CHECK(words.starts_with("VN-100 on " + rig.sensor.path() + ": unplugged"));

  rig.count(1'200ms);
  rig.sensor.set_plugged(true);
  CHECK(rig.wait_for(DeviceState::kMeasuring) < 2'000.0);
  CHECK(rig.count(500ms) > 50);
  CHECK(rig.health("imu").first == ipc::HealthLevel::kOk);
}

TEST_CASE(
    "the pressure of an IMU is not the robot's unless the configuration says so; the thread stops at once") {
  Rig rig(false);
  rig.wait_for(DeviceState::kMeasuring);
  CHECK(rig.count(300ms) > 20);
  CHECK(rig.pressures == 0);
  const auto before = std::chrono::steady_clock::now();
  rig.imu.worker().stop();
  CHECK(std::chrono::steady_clock::now() - before < 1s);
}

}  // namespace isobar::test::test_imu_thread
