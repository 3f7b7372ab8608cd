// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/health.hpp"
#include "daemon/input_health.hpp"
#include "daemon/path_choice.hpp"
#include "daemon/start_over.hpp"
#include "daemon/waiting_log.hpp"

namespace isobar::test::test_input_health {
namespace {

using ipc::HealthLevel;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kNow = 1'700'000'000 * kSecond;

std::optional<ipc::HealthEntry> entry(const ipc::HealthReport& report, const std::string& name) {
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    if (report.entries[i].name == name) return report.entries[i];
  }
  return std::nullopt;
}

PressureSample base_sample(SamplePath path, std::int64_t stamp_ns) {
  PressureSample sample{stamp_ns, 98'000.0, 20.0};
  sample.path = path;
  return sample;
}

}  // namespace

TEST_CASE("Of a base station on two paths one is used; the other takes over late and gives way at once") {
  PathChoice choice(PathChoice::kBaseTakeoverNs);
  std::int64_t now_ns = kNow;
  for (int i = 0; i < 100; ++i) {
    now_ns += kSecond;
    CHECK(choice.check(base_sample(SamplePath::kDds, now_ns)));
    CHECK_FALSE(choice.check(base_sample(SamplePath::kDatagram, now_ns)));
  }
  CHECK(choice.status().refused == 100);
  const std::int64_t last_ns = now_ns;
  while (!choice.check(base_sample(SamplePath::kDatagram, now_ns))) now_ns += kSecond / 10;
  CHECK(now_ns - last_ns > PathChoice::kBaseTakeoverNs);
  CHECK(now_ns - last_ns < PathChoice::kBaseTakeoverNs + kSecond);
  CHECK(choice.check(base_sample(SamplePath::kDds, now_ns)));
  CHECK_FALSE(choice.check(base_sample(SamplePath::kDatagram, now_ns)));
  CHECK(choice.status().takeovers == 1);
}

TEST_CASE("Of an IMU on two paths the first is used, and the other is named") {
  PathChoice choice(PathChoice::kSensorTakeoverNs);
  const auto imu = [](SamplePath path, std::int64_t stamp_ns) {
    ImuSample sample;
    sample.stamp_ns = stamp_ns;
    sample.path = path;
    return sample;
  };
  std::int64_t now_ns = kNow;
  for (int i = 0; i < 500; ++i, now_ns += kSecond / 100) {
    CHECK(choice.check(imu(SamplePath::kDatagram, now_ns)));
    CHECK_FALSE(choice.check(imu(SamplePath::kDds, now_ns + kSecond / 300)));
  }
  ipc::HealthReport report;
  add_paths(report, "imu", choice.status(), now_ns);
  const auto said = entry(report, "imu/paths");
  REQUIRE(said.has_value());
  CHECK(said->level == ipc::HealthLevel::kWarning);
  CHECK(std::string(said->message) == "a second sender, over DDS: refused; the one over datagrams is used");
  CHECK(choice.check(imu(SamplePath::kDds, now_ns + 6 * kSecond)));
}

TEST_CASE("A rate of scans that no lidar has, and a second lidar, are errors and warnings that name them") {
  Config config;
  HealthMonitor monitor(config);
  const auto now = std::make_unique<StatusSnapshot>();
  now->now_ns = kNow;
  ipc::HealthReport first;
  monitor.fill(*now, first);
  now->now_ns += kSecond;
  now->lidar.counters.scans = 494;
  now->lidar.last_packet_ns = now->now_ns;
  now->lidar.sender.in_use = {0xC0A801C9, 0};
  now->lidar.sender.other = {0xC0A801CA, 0};
  now->lidar.sender.other_ns = now->now_ns;
  now->lidar.sender.refused = 750;
  ipc::HealthReport report;
  monitor.fill(*now, report);
  REQUIRE(entry(report, "lidar").has_value());
  CHECK(entry(report, "lidar")->level == HealthLevel::kError);
  REQUIRE(entry(report, "lidar/senders").has_value());
  CHECK(entry(report, "lidar/senders")->level == HealthLevel::kWarning);
  const std::string text = entry(report, "lidar/senders")->message;
  CHECK(text == "192.168.1.201 is used, 192.168.1.202 sends, too: refused; lidar.sender chooses");
}

TEST_CASE("An input that waits for its address is an error with the reason, though nothing was received") {
  Config config;
  HealthMonitor monitor(config);
  const auto now = std::make_unique<StatusSnapshot>();
  now->now_ns = kNow;
  now->lidar_waits_for = "UDP 192.168.1.77:2368: no network interface of this machine has that address";
  now->samples_wait_for = "UDP 127.0.0.1:7373: the port is in use by another program";
  ipc::HealthReport report;
  monitor.fill(*now, report);
  CHECK(entry(report, "lidar")->level == HealthLevel::kError);
  CHECK(std::string(entry(report, "lidar")->message) == "waiting: " + now->lidar_waits_for);
  CHECK(std::string(entry(report, "input")->message) == "waiting: " + now->samples_wait_for);
}

// What happens                                   lidar's clock            IMU's stream              new map frame
// isobard stopped and continued, 3 s, 8 s        goes on                  goes on                   no
// its sender stopped and continued               stands, goes on          stands, goes on           no
// all packets lost for 5 s                       goes on                  goes on                   no
// all late by 3 s, in one bunch                  goes on                  goes on                   no
// lost, then late, then in time (busy machine)   goes on                  goes on                   no
// this machine and its clock stood, up to 30 s   ahead by the standstill  ahead by the standstill   no
// lidar restarts, or gets the time, alone        jumps                    goes on                   no
// IMU restarts alone                             goes on                  begins anew               no
// both restart, the robot stands                 jumps after 5 s or more  begins anew after 1 s     no
// the clocks of both are set                     jumps                    is set without a pause    no
// a recording again, at once or after a pause    jumps back               begins anew, at once      yes
// another recording                              jumps                    begins anew, at once      yes
// Streams: ClockContinuity and StreamBeginnings, test_clock_continuity.cpp; below: what both together say.
TEST_CASE("The input starts over when the lidar's clock jumps and the IMU begins anew, together; once") {
  StartOver start;
  CHECK_FALSE(start.check({}));
  CHECK_FALSE(start.check({0, kNow - 300 * kSecond}));                     // an IMU alone
  CHECK_FALSE(start.check({kNow - 200 * kSecond, kNow - 300 * kSecond}));  // a lidar alone
  CHECK_FALSE(start.check({kNow - 88 * kSecond, kNow - 100 * kSecond}));   // both restart
  CHECK(start.check({kNow, kNow + kSecond}));
  CHECK_FALSE(start.check({kNow, kNow + kSecond}));
  CHECK_FALSE(start.check({kNow + 2 * kSecond, kNow + kSecond}));  // a lidar alone, soon after
  CHECK(start.check({kNow + 90 * kSecond, kNow + 89 * kSecond}));
  CHECK(start.count() == 2);
}

TEST_CASE("An input that starts over is a warning in the report, counted") {
  Config config;
  HealthMonitor monitor(config);
  const auto now = std::make_unique<StatusSnapshot>();
  now->now_ns = kNow;
  CHECK_FALSE(monitor.input_starts_over(now->lidar, now->samples, now->prior));
  ipc::HealthReport before;
  monitor.fill(*now, before);
  CHECK_FALSE(entry(before, "input/starts_over").has_value());
  now->lidar.clock_jumped_ns = kNow;
  now->samples.imu_began_ns = kNow;
  now->samples.counters.samples[0] = 1;
  CHECK(monitor.input_starts_over(now->lidar, now->samples, now->prior));
  CHECK_FALSE(monitor.input_starts_over(now->lidar, now->samples, now->prior));
  ipc::HealthReport report;
  monitor.fill(*now, report);
  CHECK(entry(report, "input/starts_over")->level == HealthLevel::kWarning);
  CHECK(entry(report, "input/starts_over")->value == 1.0);
}

TEST_CASE("A barometer of this machine whose device file is missing is waited for, and said so") {
  DeviceThreadStatus barometer;
  CHECK(waiting_for(barometer).empty());
  barometer.present = true;
  std::string("DPS310 on /dev/i2c-1 at 0x77").copy(barometer.place.data(), barometer.place.size() - 1);
  CHECK(waiting_for(barometer).empty());
  barometer.device.state = DeviceState::kNoAnswer;
  std::string("no such device file").copy(barometer.device.fault.data(), barometer.device.fault.size() - 1);
  CHECK(waiting_for(barometer) == "DPS310 on /dev/i2c-1 at 0x77: no such device file");
}

TEST_CASE("A wait is logged once, then every minute, and its end once") {
  WaitingLog log;
  std::size_t lines = 0;
  for (int second = 0; second < 150; ++second) {
    lines += log.due({"UDP 1.2.3.4:5: is not there", ""}, kNow + second * kSecond).size();
  }
  CHECK(lines == 3);
  CHECK(log.due({"", ""}, kNow + 150 * kSecond).size() == 1);
  CHECK(log.due({"", ""}, kNow + 151 * kSecond).empty());
}

TEST_CASE("A step of the system clock is a warning for ten seconds, and stays counted") {
  SystemClockWatch system(0);
  const auto read = [&](std::int64_t monotonic_ns, std::int64_t set_by_ns) {
    system.note({monotonic_ns, monotonic_ns + set_by_ns, 100});
  };
  read(kNow, 0);
  read(kNow + kSecond, 3 * 86'400 * kSecond + 3'723 * kSecond);
  ipc::HealthReport report;
  add_system_clock(report, system, kNow + 2 * kSecond);
  CHECK(report.entries[0].level == HealthLevel::kWarning);
  CHECK(std::string(report.entries[0].message).find("set 1 times since the start, by +3 days 01:02:03") == 0);
  add_system_clock(report, system, kNow + 20 * kSecond);
  CHECK(report.entries[1].level == HealthLevel::kOk);
  CHECK(report.entries[1].value == 1.0);
}

}  // namespace isobar::test::test_input_health
