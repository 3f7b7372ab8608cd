// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/core/time/simulated_base.hpp"

namespace isobar::test::test_base_station_stream {

using namespace base_stations;  // NOLINT(google-build-using-namespace)
using V = BaseVerdict;

TEST_CASE("At 1 Hz and at 32 Hz every timely sample is accepted, with its true time on the robot's clock") {
  for (const double rate_hz : {1.0, 32.0}) {
    const Base base = base_at(rate_hz);
    Listener robot;
    std::mt19937_64 random(3);
    std::exponential_distribution<double> jitter(1.0 / 3e6);  // 3 ms on average
    std::uint64_t given = 0;
    for (std::int64_t i = 0; i < base.samples_in(120 * kSecond); ++i) {
      if (random() % 10 == 0) continue;  // lost
      ++given;
      const std::int64_t delay_ns =
          kMs + static_cast<std::int64_t>(jitter(random)) + (i % 37 == 36 ? 800 * kMs : 0);
      CHECK(robot.give(base, i, delay_ns) == V::kAccepted);
      CHECK_FALSE(robot.stream.lost(kRobot + i * base.period_ns + delay_ns + base.period_ns));
    }
    CHECK(robot.count(V::kAccepted) == given);
    // Largest error: the jitter of the first sample, some ms, until a less delayed one arrives.
    CHECK(robot.worst_error_ms < 25.0);
    CHECK(robot.stream.status().clock_steps == 0);
    CHECK(robot.stream.status().clock_ahead_ns / kSecond == (kBase - kRobot) / kSecond);
  }
}

TEST_CASE("Silence is detected after four learnt intervals, at least half a second, and its end is counted") {
  for (const auto& [rate_hz, limit_s] : {std::pair{0.2, 20.0}, std::pair{1.0, 4.0}, std::pair{32.0, 0.5}}) {
    const Base base = base_at(rate_hz);
    Listener robot;
    for (std::int64_t i = 0; i < 40; ++i) robot.give(base, i);
    const std::int64_t last_ns = kRobot + 39 * base.period_ns + 2 * kMs;
    const auto limit_ns = static_cast<std::int64_t>(limit_s * 1e9);
    CHECK_FALSE(robot.stream.lost(last_ns + limit_ns - kMs));
    CHECK(robot.stream.lost(last_ns + limit_ns + kMs));
    CHECK(robot.stream.status().lost(last_ns + limit_ns + kMs));
    CHECK(robot.give(base, 39 + base.samples_in(100 * kSecond)) == V::kAccepted);
    CHECK(robot.stream.status().outages == 1);
    // One outage of 100 s must not look like an interval of 100 s.
    CHECK(robot.stream.status().limit_ns < 2 * limit_ns);
  }
}

TEST_CASE("A base that becomes slower is learnt within some ten samples") {
  Listener robot;
  const Base fast = base_at(32.0);
  for (std::int64_t i = 0; i < 320; ++i) robot.give(fast, i);
  Base slow = base_at(1.0);
  for (std::int64_t i = 11; i < 21; ++i) robot.give(slow, i);
  const std::uint64_t outages = robot.stream.status().outages;
  for (std::int64_t i = 21; i < 40; ++i) robot.give(slow, i);
  CHECK(robot.stream.status().outages == outages);
  CHECK(robot.stream.status().interval_ns == doctest::Approx(1e9).epsilon(0.05));
}

TEST_CASE("Copies and overtaken samples are refused with their own verdicts, without side effects") {
  const Base base;
  Listener robot;
  for (std::int64_t i = 0; i < 320; ++i) {
    const std::int64_t j = i % 16 == 5 ? i + 1 : i % 16 == 6 ? i - 1 : i;  // 5 and 6 swapped
    CHECK(robot.give(base, j, 40 * kMs) == (i % 16 == 6 ? V::kOutdated : V::kAccepted));
    if (i % 10 == 3) CHECK(robot.give(base, j, 41 * kMs) == (i % 16 == 6 ? V::kOutdated : V::kRepeated));
  }
  CHECK(robot.count(V::kOutdated) + robot.count(V::kRepeated) == 20 + 32);
  CHECK(robot.stream.status().clock_steps == 0);
}

TEST_CASE(
    "A replay of accepted samples is always refused: beside the base, after it, and from another sender") {
  for (const double rate_hz : {1.0, 32.0}) {
    const Base base = base_at(rate_hz);
    const std::int64_t minute = base.samples_in(60 * kSecond);
    Listener robot;
    for (std::int64_t i = 0; i < minute; ++i) robot.give(base, i);
    const auto replay = [&](std::int64_t i, std::int64_t begin, std::uint64_t sender) {
      const std::int64_t since_ns = (i - (i - begin) % minute) * base.period_ns;
      return robot.give(base, (i - begin) % minute, since_ns + 5 * kMs, sender);
    };
    for (std::int64_t i = minute; i < 2 * minute; ++i) {
      CHECK(robot.give(base, i) == V::kAccepted);
      CHECK(replay(i, minute, kFirst) != V::kAccepted);
    }
    for (std::int64_t i = 2 * minute; i < 3 * minute; ++i)
      CHECK(replay(i, 2 * minute, kFirst) != V::kAccepted);
    for (std::int64_t i = 3 * minute; i < 4 * minute; ++i) {
      CHECK(replay(i, 3 * minute, kSecondSender) != V::kAccepted);
    }
    CHECK(robot.count(V::kAccepted) == static_cast<std::uint64_t>(2 * minute));
    // The base itself returns unaffected.
    CHECK(robot.give(base, 4 * minute) == V::kAccepted);
    CHECK(robot.worst_error_ms < 20.0);  // drift of 100 ppm over two silent minutes
  }
}

TEST_CASE("A recording of last week is refused at any speed while the base is alive") {
  for (const std::int64_t speed : {1, 10, 1000}) {
    const Base base;
    Base old;
    old.clock_ns = kBase - 600'000 * kSecond;
    old.pressure_pa = 97'000.0;
    Listener robot;
    for (std::int64_t i = 0; i < 960; ++i) {
      CHECK(robot.give(base, i) == V::kAccepted);
      for (std::int64_t k = 0; k < speed && i * speed + k < 4000; ++k) {
        PressureSample sample = old.sample(i * speed + k);
        CHECK(robot.stream.check(kFirst, sample, kRobot + i * base.period_ns + 4 * kMs) == V::kOutdated);
      }
    }
  }
}

TEST_CASE(
    "A file played faster than real time is not accepted as a set clock, even when the base is silent") {
  const Base base;
  Listener robot;
  for (std::int64_t i = 0; i < 320; ++i) robot.give(base, i);
  Base file;
  file.clock_ns = kBase - 600'000 * kSecond;
  for (std::int64_t i = 0; i < 20'000; ++i) {
    PressureSample sample = file.sample(i);
    CHECK(robot.stream.check(kFirst, sample, kRobot + 11 * kSecond + i * 3 * kMs) == V::kOutdated);
  }
}

TEST_CASE("A clock set forward or back is followed within three seconds and counted once") {
  for (const double rate_hz : {1.0, 32.0}) {
    for (const std::int64_t jump_ns :
         {3'600 * kSecond, -3'600 * kSecond, 7 * kSecond, -7 * kSecond, kSecond / 5, -kSecond / 5}) {
      CAPTURE(rate_hz);
      CAPTURE(jump_ns);
      const Base before = base_at(rate_hz);
      Base after = before;
      after.clock_ns += jump_ns;
      Listener robot;
      const std::int64_t minute = before.samples_in(60 * kSecond);
      for (std::int64_t i = 0; i < minute; ++i) robot.give(before, i);
      const std::int64_t settled = minute + before.samples_in(3 * kSecond);
      for (std::int64_t i = minute; i < settled; ++i) robot.give(after, i);
      robot.worst_error_ms = 0.0;
      for (std::int64_t i = settled; i < settled + minute; ++i) CHECK(robot.give(after, i) == V::kAccepted);
      CHECK(robot.worst_error_ms < 25.0);
      // A clock set back by a fifth of a second looks like a delay: no step is counted.
      CHECK(robot.stream.status().clock_steps == (jump_ns == -kSecond / 5 ? 0 : 1));
    }
  }
}

TEST_CASE("Absurd stamps are refused without side effects") {
  const Base base;
  Listener robot;
  for (std::int64_t i = 0; i < 640; ++i) {
    CHECK(robot.give(base, i) == V::kAccepted);
    if (i % 7 != 0 || i == 0) continue;
    Base absurd = base;
    absurd.clock_ns = (i % 2 == 0 ? 4'000'000'000 : 5) * kSecond - i * 13 * kSecond / 1000;
    CHECK(robot.give(absurd, i, 3 * kMs) == (i % 2 == 0 ? V::kAhead : V::kOutdated));
  }
  CHECK(robot.stream.status().clock_steps == 0);
  CHECK(robot.worst_error_ms < 3.0);
}

TEST_CASE("A sample delayed for too long is refused, a less delayed one keeps its true time") {
  const Base base;
  Listener robot;
  for (std::int64_t i = 0; i < 320; ++i) robot.give(base, i);
  // The network is blocked for 8 s; then everything arrives at once.
  const std::int64_t last = 320 + base.samples_in(8 * kSecond);
  for (std::int64_t i = 320; i < last; ++i) {
    const std::int64_t delay_ns = (last - i) * base.period_ns;
    CHECK(robot.give(base, i, delay_ns) == (delay_ns > 5 * kSecond + 2 * kMs ? V::kTooOld : V::kAccepted));
  }
  for (std::int64_t i = last; i < last + 320; ++i) CHECK(robot.give(base, i) == V::kAccepted);
  CHECK(robot.count(V::kTooOld) == 96);
  CHECK(robot.worst_error_ms < 3.0);
  CHECK(robot.stream.status().clock_steps == 0);
}

TEST_CASE("A first sample delayed by seconds is corrected by the following ones") {
  for (const double rate_hz : {1.0, 32.0}) {
    const Base base = base_at(rate_hz);
    Listener robot;
    robot.give(base, 0, 3 * kSecond);
    const std::int64_t start = base.samples_in(3 * kSecond) + 1;
    for (std::int64_t i = start; i < start + base.samples_in(3 * kSecond); ++i) robot.give(base, i);
    robot.worst_error_ms = 0.0;
    for (std::int64_t i = start + base.samples_in(3 * kSecond); i < start + 200; ++i) {
      CHECK(robot.give(base, i) == V::kAccepted);
    }
    CHECK(robot.worst_error_ms < 3.0);
  }
}

}  // namespace isobar::test::test_base_station_stream
