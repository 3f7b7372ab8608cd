// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_summary.hpp"

#include <doctest/doctest.h>

#include <string>

namespace isobar::test::test_health_summary {

namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

constexpr std::int64_t kSecond = 1'000'000'000;

HealthLevel held_level(LevelHold& hold, std::int64_t now_ns, const char* name, HealthLevel level) {
  HealthReport report;
  CHECK(report.add(name, level, "packets lost", 1.0));
  hold.apply(now_ns, report);
  return report.entries[0].level;
}

}  // namespace

TEST_CASE("the summary is green when all is well, else it names the first of the worst entries") {
  HealthReport report;
  reserve_summary(report);
  CHECK(report.add("imu", HealthLevel::kOk, "200.0 per second", 200.0));
  fill_summary(report);
  CHECK(std::string(report.entries[0].name) == "summary");
  CHECK(report.entries[0].level == HealthLevel::kOk);
  CHECK(std::string(report.entries[0].message) == "all is well");
  CHECK(report.add("wheels", HealthLevel::kWarning, "late", 0.0));
  CHECK(report.add("height", HealthLevel::kStale, "no IMU sample for 3 s", 0.0));
  CHECK(report.add("lidar", HealthLevel::kError, "silent for 3 s", 0.0));
  CHECK(report.add("map", HealthLevel::kError, "disk full", 0.0));
  fill_summary(report);
  CHECK(report.entries[0].level == HealthLevel::kError);
  CHECK(std::string(report.entries[0].message) == "lidar: silent for 3 s (and 3 more)");
  CHECK(report.entries[0].value == 4.0);
}

TEST_CASE("a long message keeps the number of the other faults") {
  HealthReport report;
  reserve_summary(report);
  CHECK(report.add("lidar", HealthLevel::kError, std::string(119, 'x'), 0.0));
  CHECK(report.add("map", HealthLevel::kWarning, "", 0.0));
  fill_summary(report);
  CHECK(std::string(report.entries[0].message).ends_with("x (and 1 more)"));
}

TEST_CASE("a counter stays a warning for ten seconds after its last growth; a sensor recovers at once") {
  LevelHold hold;
  CHECK(held_level(hold, 0, "lidar/lost", HealthLevel::kWarning) == HealthLevel::kWarning);
  CHECK(held_level(hold, 9 * kSecond, "lidar/lost", HealthLevel::kOk) == HealthLevel::kWarning);
  CHECK(held_level(hold, 10 * kSecond, "lidar/lost", HealthLevel::kOk) == HealthLevel::kOk);
  CHECK(held_level(hold, 0, "lidar", HealthLevel::kWarning) == HealthLevel::kWarning);
  CHECK(held_level(hold, kSecond, "lidar", HealthLevel::kOk) == HealthLevel::kOk);
  CHECK(held_level(hold, kSecond, "imu/lost", HealthLevel::kOk) == HealthLevel::kOk);
}

}  // namespace isobar::test::test_health_summary
