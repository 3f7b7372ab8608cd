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
    const std::int64_t back = goodbye ? 321 : 481;  // at 32 Hz: at once, or after 5 s of silence
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
  }
}

TEST_CASE("A first base station that returns after it was replaced is used again at once, and stays") {
  const Base base;
  Base other;
  other.pressure_pa = 97'900.0;
  Listener robot;
  for (std::int64_t i = 0; i < 320; ++i) {
    robot.give(base, i);
    robot.give(other, i, 3 * kMs, kSecondSender);
  }
  const std::int64_t replaced = 320 + base.samples_in(16 * kSecond);
  for (std::int64_t i = 320; i < replaced; ++i) robot.give(other, i, 3 * kMs, kSecondSender);
  REQUIRE(robot.stream.sender() == kSecondSender);
  for (std::int64_t i = replaced; i < replaced + 320; ++i) {
    CHECK(robot.give(base, i) == V::kAccepted);
    CHECK(robot.give(other, i, 3 * kMs, kSecondSender) == V::kOtherSender);
  }
  CHECK(robot.stream.status().returns == 1);
  CHECK(robot.worst_error_ms < 5.0);
}

TEST_CASE("In a gap of 1 s of the true base station a rogue neither takes over nor locks it out") {
  const Base base;
  Base rogue;
  rogue.pressure_pa = 97'900.0;
  Listener robot;
  for (std::int64_t i = 0; i < 320; ++i) robot.give(base, i);
  for (std::int64_t i = 320; i < 352; ++i) {
    CHECK(robot.give(rogue, i, 3 * kMs, kSecondSender) == V::kOtherSender);
  }
  for (std::int64_t i = 352; i < 992; ++i) {
    CHECK(robot.give(base, i) == V::kAccepted);
    CHECK(robot.give(rogue, i, 3 * kMs, kSecondSender) == V::kOtherSender);
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
  // Killed and back within 2 s without notice: five silent seconds must pass and three samples agree.
  std::int64_t first_taken = 0;
  for (std::int64_t i = 21; i < 40 && first_taken == 0; ++i) {
    if (robot.give(base, i, 2 * kMs, kSecondSender) == V::kAccepted) first_taken = i;
  }
  CHECK(first_taken >= 25);
  CHECK(first_taken <= 27);
  CHECK(robot.stream.status().restarts == 1);
  CHECK(robot.stream.status().rival_ns == 0);
}

}  // namespace isobar::test::test_base_station_senders
