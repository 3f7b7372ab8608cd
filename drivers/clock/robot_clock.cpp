// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/clock/robot_clock.hpp"

#include <ctime>

namespace isobar {
namespace {

std::int64_t read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return read_clock(CLOCK_MONOTONIC); }

ClockPair read_clocks() noexcept {
  // A reading that took longer was interrupted between the clocks: read again.
  constexpr std::int64_t kUsualNs = 20'000;
  constexpr int kAttempts = 3;
  ClockPair best{0, 0, INT64_MAX};
  for (int attempt = 0; attempt < kAttempts && best.apart_ns > kUsualNs; ++attempt) {
    const std::int64_t before_ns = monotonic_ns();
    const std::int64_t system_ns = read_clock(CLOCK_REALTIME);
    const std::int64_t after_ns = monotonic_ns();
    const std::int64_t apart_ns = after_ns - before_ns;
    if (apart_ns < best.apart_ns) best = {before_ns + apart_ns / 2, system_ns, apart_ns};
  }
  return best;
}

std::int64_t RobotClock::offset_ns() noexcept {
  static const std::int64_t offset_ns = [] {
    const ClockPair now = read_clocks();
    return now.system_ns - now.monotonic_ns;
  }();
  return offset_ns;
}

std::int64_t RobotClock::now_ns() noexcept { return monotonic_ns() + offset_ns(); }

}  // namespace isobar
