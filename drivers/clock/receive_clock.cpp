// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/clock/receive_clock.hpp"

namespace isobar {
namespace {

/// The kernel stamps a datagram milliseconds before it is read; nothing waits longer in a socket.
constexpr std::int64_t kMaxAgeNs = 1'000'000'000;

bool is_age(std::int64_t age_ns) { return age_ns >= 0 && age_ns <= kMaxAgeNs; }

}  // namespace

ReceiveClock::ReceiveClock(ClockSource source) noexcept : source_(source), system_(RobotClock::offset_ns()) {
  system_.note(source_());
}

std::int64_t ReceiveClock::now_ns() noexcept {
  const ClockPair now = source_();
  system_.note(now);
  return now.monotonic_ns + RobotClock::offset_ns();
}

std::int64_t ReceiveClock::to_robot_ns(std::int64_t system_ns) noexcept {
  const ClockPair now = source_();
  system_.note(now);
  std::int64_t age_ns = now.system_ns - system_ns;
  const bool just_set =
      system_.changed_monotonic_ns() != 0 && now.monotonic_ns - system_.changed_monotonic_ns() < kMaxAgeNs;
  if (just_set) {
    // Received before or after the clock was set? The later of the possible times.
    const std::int64_t age_before_ns = age_ns - system_.last_change_ns();
    if (is_age(age_before_ns) && (!is_age(age_ns) || age_before_ns < age_ns)) age_ns = age_before_ns;
  }
  return now.monotonic_ns + RobotClock::offset_ns() - (is_age(age_ns) ? age_ns : 0);
}

}  // namespace isobar
