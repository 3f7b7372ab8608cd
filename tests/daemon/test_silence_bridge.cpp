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

}  // namespace isobar::test::test_silence_bridge
