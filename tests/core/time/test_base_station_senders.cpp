// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdint>

#include "tests/core/time/simulated_base.hpp"

namespace isobar::test::test_base_station_senders {

using namespace base_stations;  // NOLINT(google-build-using-namespace)
using V = BaseVerdict;

TEST_CASE(
    "A restarted base is accepted within half a second of its return once the old one has ended or is "
    "silent") {
  for (const bool goodbye : {true, false}) {
    const Base before;
    Base after;
    after.clock_ns = kBase / 2;  // another start of its clock
    Listener robot;
    for (std::int64_t i = 0; i < 320; ++i) robot.give(before, i);
    if (goodbye) robot.stream.sender_gone(kFirst);
    CHECK(robot.stream.lost(kRobot + 10 * kSecond) == goodbye);
    const std::int64_t back = goodbye ? 321 : 337;  // at 32 Hz: at once, or after half a second of silence
    for (std::int64_t i = back; i < back + 64; ++i) {
      // Half a second of confirmation: no single message can replace a base.
      CHECK(robot.give(after, i, 2 * kMs, kSecondSender) == (i < back + 16 ? V::kUnconfirmed : V::kAccepted));
    }
    CHECK(robot.stream.status().restarts == 1);
    CHECK(robot.stream.status().clock_steps == 0);
    CHECK(robot.worst_error_ms < 3.0);
    CHECK_FALSE(robot.stream.lost(kRobot + (back + 64) * before.period_ns));
  }
}

TEST_CASE(
    "Of two base stations of one name the first is used, the other only long after the first has ended") {
  const Base base;
  Base other;
  other.pressure_pa = 97'900.0;  // 8 m higher
  Listener robot;
  for (std::int64_t i = 0; i < 640; ++i) {
    CHECK(robot.give(base, i) == V::kAccepted);
    CHECK(robot.give(other, i, 3 * kMs, kSecondSender) == V::kOtherSender);
  }
  CHECK(robot.stream.status().rival_ns > kRobot);
  const std::int64_t takeover = 640 + base.samples_in(15 * kSecond);
  for (std::int64_t i = 640; i < takeover - 40; ++i) {
    CHECK(robot.give(other, i, 3 * kMs, kSecondSender) == V::kOtherSender);
  }
  // The first one, restarted, has priority over its rival.
  SUBCASE("the first one is started again") {
    for (std::int64_t i = takeover - 40; i < takeover + 64; ++i) {
      CHECK(robot.give(base, i, 3 * kMs, 33) == (i < takeover - 24 ? V::kUnconfirmed : V::kAccepted));
      CHECK(robot.give(other, i, 3 * kMs, kSecondSender) == V::kOtherSender);
    }
  }
  SUBCASE("the first one stays away") {
    for (std::int64_t i = takeover; i < takeover + 64; ++i) {
      CHECK(robot.give(other, i, 3 * kMs, kSecondSender) ==
            (i < takeover + 16 ? V::kUnconfirmed : V::kAccepted));
    }
    CHECK(robot.give(base, takeover + 64) == V::kOtherSender);
  }
}

TEST_CASE("Two new base stations that start together do not block each other") {
  Base one;
  Base two;
  two.pressure_pa = 97'900.0;
  Listener robot;
  for (std::int64_t i = 0; i < 320; ++i) robot.give(one, i);
  robot.stream.sender_gone(kFirst);
  for (std::int64_t i = 321; i < 385; ++i) {
    robot.give(one, i, 2 * kMs, kSecondSender);
    CHECK(robot.give(two, i, 3 * kMs, 33) == V::kOtherSender);
  }
  CHECK(robot.stream.sender() == kSecondSender);
  CHECK(robot.stream.status().restarts == 1);
}

TEST_CASE("A slow base restarted before its silence is detected does not count as a second base station") {
  const Base base = base_at(1.0);
  Listener robot;
  for (std::int64_t i = 0; i < 20; ++i) robot.give(base, i);
  // Killed and back within 2 s without notice: four silent seconds must pass and three samples agree.
  std::int64_t first_taken = 0;
  for (std::int64_t i = 21; i < 40 && first_taken == 0; ++i) {
    if (robot.give(base, i, 2 * kMs, kSecondSender) == V::kAccepted) first_taken = i;
  }
  CHECK(first_taken >= 24);
  CHECK(first_taken <= 26);
  CHECK(robot.stream.status().restarts == 1);
  CHECK(robot.stream.status().rival_ns == 0);
}

}  // namespace isobar::test::test_base_station_senders
