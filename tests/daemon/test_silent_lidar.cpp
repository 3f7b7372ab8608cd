// SPDX-License-Identifier: BSD-3-Clause
// When a lidar counts as silent, in the health report.
#include <doctest/doctest.h>

#include <string>

#include "daemon/health.hpp"

namespace isobar::test::test_silent_lidar {

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart = 1'000'000 * kMs;

/// The entry of the lidar in a report about a robot whose other sensors were never heard. Times must ascend.
ipc::HealthEntry lidar_entry(HealthMonitor& monitor, const LidarStatus& lidar, std::int64_t now_ns) {
  StatusSnapshot status;
  status.now_ns = now_ns;
  status.lidar = lidar;
  ipc::HealthReport report;
  monitor.fill(status, report);
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    if (std::string("lidar") == report.entries[i].name) return report.entries[i];
  }
  FAIL("no entry");
  return {};
}

}  // namespace

TEST_CASE(
    "a lidar is silent after two and a half turns once its thread waits in vain, after a second otherwise") {
  LidarStatus lidar;
  lidar.last_packet_ns = kStart;
  lidar.silence_ns = 250 * kMs;    // 10 Hz
  lidar.waited_ns = kStart - kMs;  // the thread has not run since: packets may be waiting
  using ipc::HealthLevel;
  const auto entry_after = [&lidar](std::int64_t age_ns) {
    HealthMonitor monitor{Config{}};
    return lidar_entry(monitor, lidar, kStart + age_ns);
  };
  CHECK(entry_after(260 * kMs).level == HealthLevel::kOk);
  CHECK(entry_after(1'010 * kMs).level == HealthLevel::kError);
  lidar.waited_ns = kStart + 200 * kMs;
  CHECK(entry_after(250 * kMs).level == HealthLevel::kOk);
  CHECK_FALSE(is_silent(lidar, kStart + 250 * kMs));
  CHECK(is_silent(lidar, kStart + 251 * kMs));
  const ipc::HealthEntry silent = entry_after(251 * kMs);
  CHECK(silent.level == HealthLevel::kError);
  CHECK(std::string(silent.message).starts_with("silent for 0.3 s on UDP port"));
  CHECK_FALSE(is_silent({}, kStart));  // never heard: not there yet
}

TEST_CASE("scans are not counted too many in a report that follows the last one at once") {
  HealthMonitor monitor{Config{}};
  LidarStatus lidar;
  lidar.last_packet_ns = kStart;
  (void)lidar_entry(monitor, lidar, kStart);
  ++lidar.counters.scans;  // within 20 ms: 50 a second
  CHECK(lidar_entry(monitor, lidar, kStart + 20 * kMs).level == ipc::HealthLevel::kOk);
  lidar.counters.scans += 40;  // two lidars at 20 Hz
  lidar.last_packet_ns = kStart + 1'000 * kMs;
  CHECK(lidar_entry(monitor, lidar, kStart + 1'020 * kMs).level == ipc::HealthLevel::kError);
}

}  // namespace isobar::test::test_silent_lidar
