// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/clock/robot_clock.hpp"

#include <ctime>

namespace isobar {
namespace {

/// The kernel stamps a datagram milliseconds before it is read. A wall-clock stamp older than this, or in the
/// future, was taken before the wall clock was set.
constexpr std::int64_t kMaxAgeNs = 1'000'000'000;

std::int64_t read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return read_clock(CLOCK_MONOTONIC); }

std::int64_t RobotClock::offset_ns() noexcept {
  static const std::int64_t offset_ns = read_clock(CLOCK_REALTIME) - read_clock(CLOCK_MONOTONIC);
  return offset_ns;
}

std::int64_t RobotClock::now_ns() noexcept { return monotonic_ns() + offset_ns(); }

std::int64_t RobotClock::from_realtime_ns(std::int64_t realtime_ns) noexcept {
  const std::int64_t age_ns = read_clock(CLOCK_REALTIME) - realtime_ns;
  const bool believable = age_ns >= 0 && age_ns <= kMaxAgeNs;
  return now_ns() - (believable ? age_ns : 0);
}

}  // namespace isobar
