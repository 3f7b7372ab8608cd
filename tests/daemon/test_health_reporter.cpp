// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_reporter.hpp"

#include <doctest/doctest.h>

#include <string>

#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/report_schedule.hpp"

namespace isobar::test::test_health_reporter {

namespace {

/// A graph without threads that reports more than fits.
class TalkativeGraph final : public Graph {
 public:
  explicit TalkativeGraph(int entries) : entries_(entries) {}
  void start() override {}
  void stop() override {}
  WorkerGroup& workers() override { return workers_; }
  std::string inputs() const override { return {}; }
  DeviceStates device_states() const override { return {}; }
  void fill_health(std::int64_t /*now_ns*/, ipc::HealthReport& report) override {
    for (int i = 0; i < entries_; ++i) add_entry(report, "stage", ipc::HealthLevel::kOk, "", i);
  }
  Apply apply_of(const Setting& setting) const override { return setting.apply; }
  void apply(const ConfigChange& /*change*/) override {}

 private:
  int entries_;
  WorkerGroup workers_;
};

const ipc::HealthEntry* find(const ipc::HealthReport& report, const std::string& name) {
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    if (name == report.entries[i].name) return &report.entries[i];
  }
  return nullptr;
}

}  // namespace

TEST_CASE("a report that is too long keeps the entry for threads and counts the dropped entries") {
  TalkativeGraph graph(300);
  HealthReporter reporter(graph, {"SCHED_FIFO refused"});
  ipc::HealthReport report;
  CHECK(reporter.fill(1'000'000'000, report));
  REQUIRE(report.entry_count == ipc::HealthReport::kMaxEntries);
  REQUIRE(find(report, "threads") != nullptr);
  const ipc::HealthEntry* dropped = find(report, "health/dropped");
  REQUIRE(dropped != nullptr);
  CHECK(dropped->level == ipc::HealthLevel::kWarning);
  // "summary", "threads", 300 entries and one refusal; the entry for dropped entries itself takes one place.
  CHECK(dropped->value == 2 + 300 + 1 - (ipc::HealthReport::kMaxEntries - 1));
}

TEST_CASE("a report that fits has no entry for dropped entries") {
  TalkativeGraph graph(10);
  HealthReporter reporter(graph, {});
  ipc::HealthReport report;
  CHECK(reporter.fill(1'000'000'000, report));
  CHECK(report.entry_count == 12);
  CHECK(find(report, "health/dropped") == nullptr);
}

TEST_CASE(
    "faults of the shared-memory library have an entry from the first one on, a warning while the count "
    "grows") {
  ipc::HealthReport report;
  add_library_faults(report, 0, 0);
  CHECK(find(report, "shared_memory/faults") == nullptr);
  add_library_faults(report, 2, 1);
  REQUIRE(find(report, "shared_memory/faults") != nullptr);
  CHECK(find(report, "shared_memory/faults")->level == ipc::HealthLevel::kWarning);
  CHECK(find(report, "shared_memory/faults")->value == 2.0);
  ipc::HealthReport later;
  add_library_faults(later, 2, 2);
  CHECK(find(later, "shared_memory/faults")->level == ipc::HealthLevel::kOk);
}

TEST_CASE("removed files of shared memory are an error that names them; without any there is no entry") {
  ipc::HealthReport report;
  add_missing_files(report, "");
  CHECK(report.entry_count == 0);
  add_missing_files(report, "/dev/shm/iceoryx_mgmt");
  REQUIRE(find(report, "shared_memory") != nullptr);
  CHECK(find(report, "shared_memory")->level == ipc::HealthLevel::kError);
  CHECK(std::string(find(report, "shared_memory")->message).ends_with("removed: /dev/shm/iceoryx_mgmt"));
}

TEST_CASE("parts of the program add entries of their own") {
  TalkativeGraph graph(0);
  graph.add_health([](std::int64_t, ipc::HealthReport& report) {
    add_entry(report, "disk", ipc::HealthLevel::kError, "full", 0.0);
  });
  HealthReporter reporter(graph, {});
  ipc::HealthReport report;
  CHECK(reporter.fill(1'000'000'000, report));
  REQUIRE(find(report, "disk") != nullptr);
  CHECK(std::string(report.entries[0].message) == "disk: full");
}

TEST_CASE("health is reported once a second, and at once when a sensor read here fails or recovers") {
  ReportSchedule schedule;
  std::int64_t now_ns = 5'000'000'000;
  int reports = 0;
  DeviceState imu = DeviceState::kMeasuring;
  const auto tick = [&](DeviceState barometer, int times) {
    for (int i = 0; i < times; ++i) {
      now_ns += 100'000'000;
      reports += schedule.due(now_ns, {barometer, imu}) ? 1 : 0;
    }
  };
  tick(DeviceState::kMeasuring, 10);
  CHECK(reports == 0);  // none in the first second, to give every sensor time to start
  tick(DeviceState::kMeasuring, 1);
  CHECK(reports == 1);
  tick(DeviceState::kMeasuring, 3);
  CHECK(reports == 1);
  tick(DeviceState::kSilent, 1);
  CHECK(reports == 2);
  tick(DeviceState::kSilent, 30);
  CHECK(reports == 5);
  imu = DeviceState::kNoAnswer;
  tick(DeviceState::kSilent, 1);
  CHECK(reports == 6);
}

TEST_CASE("a lidar that falls silent, and one that is back, is reported at once and then once a second") {
  ReportSchedule schedule;
  std::int64_t now_ns = 5'000'000'000;
  int reports = 0;
  const auto tick = [&](bool silent, int times) {
    for (int i = 0; i < times; ++i) {
      now_ns += 25'000'000;
      reports += schedule.due(now_ns, {}, silent) ? 1 : 0;
    }
  };
  tick(false, 50);
  CHECK(reports == 1);
  tick(true, 1);
  CHECK(reports == 2);
  tick(true, 39);
  CHECK(reports == 2);
  tick(true, 1);
  CHECK(reports == 3);
  tick(false, 1);
  CHECK(reports == 4);
}

}  // namespace isobar::test::test_health_reporter
