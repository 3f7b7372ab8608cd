// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/level_changes.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace isobar::test::test_level_changes {

namespace {

using ipc::HealthLevel;

constexpr std::int64_t kSecond = 1'000'000'000;

/// Lines of an entry whose level alternates between ok and `bad` each second for this long.
std::vector<LevelChange> lines_of_flapping(LevelChanges& changes, HealthLevel bad, int seconds) {
  std::vector<LevelChange> lines;
  for (int second = 0; second < seconds; ++second) {
    const bool well = second % 2 == 1;
    auto line = changes.note("imu", well ? HealthLevel::kOk : bad, well ? "200.0 per second" : "silent",
                             second * kSecond);
    if (line) lines.push_back(*line);
  }
  return lines;
}

}  // namespace

TEST_CASE("the log gets a line when a level changes, without level words, and none when only values change") {
  LevelChanges changes;
  const auto text = [&](const char* name, HealthLevel level, const char* message, int second) {
    const auto change = changes.note(name, level, message, second * kSecond);
    return change ? change->text : "nothing";
  };
  CHECK(text("imu", HealthLevel::kOk, "200.0 per second", 0) == "200.0 per second");
  CHECK(text("imu", HealthLevel::kOk, "199.0 per second", 1) == "nothing");
  CHECK(text("imu", HealthLevel::kError, "silent", 2) == "silent");
  CHECK(text("imu", HealthLevel::kOk, "200.0 per second", 3) == "recovered: 200.0 per second");
  CHECK(text("lidar/lost", HealthLevel::kOk, "ok from the start", 0) == "nothing");
  CHECK(text("lidar/garbage", HealthLevel::kWarning, "17", 0) == "17");
  CHECK(text("lidar/deadline", HealthLevel::kStale, "no scans for 2 s", 0) == "nothing");
}

TEST_CASE("data that never came is awaited, data that no longer comes is a fault") {
  LevelChanges changes;
  CHECK_FALSE(changes.note("imu", HealthLevel::kStale, "nothing received yet", 0)->is_fault);
  CHECK_FALSE(changes.note("imu", HealthLevel::kOk, "", kSecond)->is_fault);
  CHECK(changes.note("imu", HealthLevel::kStale, "silent", 2 * kSecond)->is_fault);
}

TEST_CASE("an entry that flaps is folded: four lines, then one a minute with the number of changes") {
  LevelChanges changes;
  const auto lines = lines_of_flapping(changes, HealthLevel::kError, 61);
  REQUIRE(lines.size() == 5);
  CHECK(lines[4].text == "changed 61 times in the last minute, now: silent");
  CHECK(lines[4].level == HealthLevel::kError);
  CHECK(lines[4].is_fault);
}

TEST_CASE("an entry that flaps for a day stays below 30 lines an hour, and below 60 in all") {
  LevelChanges changes;
  CHECK(lines_of_flapping(changes, HealthLevel::kWarning, 3'600).size() < 30);
  CHECK(lines_of_flapping(changes, HealthLevel::kWarning, 86'400).size() < 60);
}

TEST_CASE("a fault that stays is told within five minutes, however often the entry changed before") {
  LevelChanges changes;
  static_cast<void>(lines_of_flapping(changes, HealthLevel::kWarning, 3'600));
  int told = 0;
  for (int second = 3'600; second <= 3'600 + 300; ++second) {
    const auto line = changes.note("imu", HealthLevel::kError, "silent", second * kSecond);
    told += line && line->level == HealthLevel::kError ? 1 : 0;
  }
  CHECK(told == 1);
}

TEST_CASE("after five quiet minutes the next fault is a line of its own at once") {
  LevelChanges changes;
  static_cast<void>(lines_of_flapping(changes, HealthLevel::kError, 61));
  // The changes are over: one line about the last of them, then none.
  int lines = 0;
  for (int second = 61; second < 700; ++second) {
    lines += changes.note("imu", HealthLevel::kOk, "", second * kSecond) ? 1 : 0;
  }
  CHECK(lines == 1);
  const auto fault = changes.note("imu", HealthLevel::kError, "silent", 700 * kSecond);
  REQUIRE(fault);
  CHECK(fault->text == "silent");
}

}  // namespace isobar::test::test_level_changes
