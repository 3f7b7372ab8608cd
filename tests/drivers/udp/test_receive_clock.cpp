// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdint>

#include "drivers/clock/receive_clock.hpp"

namespace isobar::test::test_receive_clock {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

ClockPair now;  // NOLINT: a ClockSource is a plain function

ClockPair read_injected() noexcept { return now; }

void pass(std::int64_t duration_ns) {
  now.monotonic_ns += duration_ns;
  now.system_ns += duration_ns;
}
std::int64_t robot_ns() { return now.monotonic_ns + RobotClock::offset_ns(); }

}  // namespace

TEST_CASE("A datagram's receive time is right while the system clock is set, or late, but never early") {
  for (const std::int64_t step_ns :
       {4 * kMs, -4 * kMs, 40 * kMs, -40 * kMs, 800 * kMs, -800 * kMs, 3 * kSecond, -86'400 * kSecond}) {
    now = {500 * kSecond, 500 * kSecond + RobotClock::offset_ns(), 100};
    ReceiveClock clock(&read_injected);
    for (int i = 0; i < 200; ++i) {
      pass(kMs);
      // Six datagrams wait in the socket; the clock is set while they do.
      const std::int64_t received_system_ns = now.system_ns;
      const std::int64_t received_robot_ns = robot_ns();
      const bool is_set = i == 100;
      if (is_set) now.system_ns += step_ns;
      pass(6 * kMs);
      const std::int64_t stamp_ns = clock.to_robot_ns(received_system_ns);
      CHECK(stamp_ns >= received_robot_ns);
      CHECK(stamp_ns <= robot_ns());
      if (i < 100) CHECK(stamp_ns == received_robot_ns);
    }
  }
}

TEST_CASE("A receive time from before a step of days is the time of reading") {
  now = {500 * kSecond, 500 * kSecond + RobotClock::offset_ns(), 100};
  ReceiveClock clock(&read_injected);
  const std::int64_t received_ns = now.system_ns;
  now.system_ns += 3 * 86'400 * kSecond;
  pass(2 * kSecond);  // longer than anything waits in a socket
  CHECK(clock.to_robot_ns(received_ns) == robot_ns());
  CHECK(clock.system().steps() == 1);
}

}  // namespace isobar::test::test_receive_clock
