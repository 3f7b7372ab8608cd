// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_station_health.hpp"

#include <doctest/doctest.h>

#include <map>
#include <string>

namespace isobar::test::test_base_station_health {

namespace {

using ipc::HealthLevel;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kNow = 1'700'000'000 * kSecond;

struct Entry {
  HealthLevel level = HealthLevel::kOk;
  std::string message;
  double value = 0.0;
};

/// All entries of the base station "base", by name.
std::map<std::string, Entry> entries(const BaseStationStatus& now, const BaseStationStatus& before = {}) {
  std::map<std::string, Entry> result;
  const AddEntry add = [&result](const std::string& name, HealthLevel level, const std::string& message,
                                 double value) {
    result[name] = {level, message, value};
  };
  add_base_station_state("base", now, kNow, "base/fluid_pressure", add);
  add_base_station_counts("base", now, before, add);
  return result;
}

BaseStationStatus healthy() {
  BaseStationStatus status;
  status.samples[0] = 320;
  status.last_ns = kNow - kSecond / 10;
  status.interval_ns = kSecond / 32;
  status.limit_ns = kSecond / 2;
  return status;
}

bool has(const Entry& entry, const char* words) { return entry.message.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("a healthy base station has one entry, with its rate and its clock offset") {
  BaseStationStatus status = healthy();
  status.clock_ahead_ns = -3 * kSecond / 2;
  const auto all = entries(status);
  REQUIRE(all.size() == 1);
  CHECK(all.at("base").level == HealthLevel::kOk);
  CHECK(all.at("base").value == doctest::Approx(32.0));
  CHECK(has(all.at("base"), "-1.5 s"));
}

TEST_CASE("never received, silent, ended and in competition are distinct states; each names the topic") {
  CHECK(entries({}).at("base").level == HealthLevel::kStale);
  BaseStationStatus silent = healthy();
  silent.last_ns = kNow - 7 * kSecond;
  CHECK(entries(silent).at("base").level == HealthLevel::kError);
  CHECK(has(entries(silent).at("base"), "silent for 7.0 s on base/fluid_pressure"));
  BaseStationStatus left = healthy();
  left.left = true;
  CHECK(entries(left).at("base").level == HealthLevel::kError);
  CHECK(has(entries(left).at("base"), "has ended"));
  BaseStationStatus rival = healthy();
  rival.rival_ns = kNow - kSecond;
  CHECK(entries(rival).at("base").level == HealthLevel::kWarning);
  CHECK(has(entries(rival).at("base"), "second base station"));
  rival.rival_ns = kNow - 60 * kSecond;  // it has gone
  CHECK(entries(rival).at("base").level == HealthLevel::kOk);
}

TEST_CASE("every kind of refusal has its own entry, a warning only while the count grows") {
  BaseStationStatus now = healthy();
  for (std::size_t verdict = 1; verdict < now.samples.size(); ++verdict) now.samples[verdict] = 10 + verdict;
  now.restarts = 1;
  now.outages = 2;
  now.clock_steps = 3;
  const auto growing = entries(now);
  CHECK(growing.size() == 1 + 6 + 3);
  CHECK(growing.at("base/too_old").value == 10.0 + static_cast<double>(BaseVerdict::kTooOld));
  CHECK(growing.at("base/clock_steps").value == 3.0);
  for (const auto& entry : growing) {
    CAPTURE(entry.first);
    CHECK(entry.second.level == (entry.first == "base" ? HealthLevel::kOk : HealthLevel::kWarning));
  }
  for (const auto& entry : entries(now, now)) {
    CAPTURE(entry.first);
    CHECK(entry.second.level == HealthLevel::kOk);
  }
}

}  // namespace isobar::test::test_base_station_health
