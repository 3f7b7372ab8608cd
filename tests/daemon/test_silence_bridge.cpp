// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/silence_bridge.hpp"

#include <doctest/doctest.h>

namespace isobar::test::test_silence_bridge {

using isobar::SilenceBridge;

TEST_CASE(
    "before the first scan poses are due at once, so that a robot has a pose as soon as it knows gravity") {
  const SilenceBridge bridge;
  CHECK(bridge.due(0));
  CHECK(bridge.in_order(-5));
}

TEST_CASE("at 10 Hz no pose comes from the prior, not even when one scan is missing") {
  SilenceBridge bridge;
  bridge.posed(0, true);
  for (std::int64_t t_ns = 0; t_ns < 200'000'000; t_ns += 5'000'000) CHECK_FALSE(bridge.due(t_ns));
}

TEST_CASE("five seconds without lidar give a pose every 100 ms after the first 250 ms") {
  SilenceBridge bridge;
  bridge.posed(0, true);
  int poses = 0;
  std::int64_t newest_ns = 0;
  for (std::int64_t t_ns = 0; t_ns <= 5'000'000'000; t_ns += 5'000'000) {
    if (!bridge.due(t_ns)) continue;
    CHECK(bridge.in_order(t_ns));
    bridge.posed(t_ns, false);
    newest_ns = t_ns;
    ++poses;
  }
  CHECK(poses == 1 + (5000 - 250) / 100);
  CHECK_FALSE(bridge.in_order(newest_ns));
}

namespace {

/// Scans of that interval, each known `late_ns` after its end; poses of silence at 10 ms steps where due.
struct Outcome {
  int scans = 0;
  int lost_poses = 0;  ///< of scans that ended before a pose of silence
  int bridged = 0;
};

Outcome drive(std::int64_t interval_ns, std::int64_t late_ns, std::int64_t until_ns) {
  SilenceBridge bridge;
  Outcome outcome;
  std::int64_t end_ns = interval_ns;
  for (std::int64_t now_ns = 0; now_ns < until_ns; now_ns += 10'000'000) {
    if (now_ns >= end_ns + late_ns) {
      bridge.scanned(end_ns);
      ++outcome.scans;
      if (bridge.in_order(end_ns)) {
        bridge.posed(end_ns, true);
      } else {
        ++outcome.lost_poses;
      }
      end_ns += interval_ns;
    }
    if (!bridge.due(now_ns)) continue;
    bridge.posed(now_ns, false);
    ++outcome.bridged;
  }
  return outcome;
}

}  // namespace

TEST_CASE(
    "a slow lidar is not silent while its next scan is collected, at 0.5 to 20 Hz, complete at once or "
    "late") {
  for (const double hz : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    for (const double late : {0.0, 0.95}) {
      CAPTURE(hz);
      CAPTURE(late);
      const auto interval_ns = static_cast<std::int64_t>(1e9 / hz);
      const auto outcome = drive(interval_ns, static_cast<std::int64_t>(late * 1e9 / hz), 20 * interval_ns);
      CHECK(outcome.scans >= 18);
      // Before the first scan, whose interval nobody knows, poses come from the prior, and once more while the
      // interval is unknown.
      CHECK(outcome.lost_poses <= 2);
    }
  }
}

TEST_CASE("the silence of a lidar at 1 Hz is bridged after 2.5 s, and one lost scan does not change that") {
  SilenceBridge bridge;
  for (int k = 0; k <= 20; ++k) {
    if (k == 12) continue;
    bridge.scanned(k * std::int64_t{1'000'000'000});
    bridge.posed(k * std::int64_t{1'000'000'000}, true);
  }
  const std::int64_t silence_ns = bridge.silence_ns();
  CHECK(silence_ns >= 2'500'000'000);
  CHECK(silence_ns < 2'700'000'000);
  CHECK_FALSE(bridge.due(20'000'000'000 + silence_ns - 1));
  CHECK(bridge.due(20'000'000'000 + silence_ns));
}

TEST_CASE("after a pause of 5 s a lidar at 10 Hz is bridged after 250 to 350 ms again") {
  SilenceBridge bridge;
  std::int64_t end_ns = 0;
  for (int k = 0; k <= 100; ++k) bridge.scanned(end_ns += 100'000'000);
  bridge.scanned(end_ns += 5'000'000'000);
  CHECK(bridge.silence_ns() < 350'000'000);
}

}  // namespace isobar::test::test_silence_bridge
