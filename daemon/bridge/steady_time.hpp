// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>

namespace isobar::bridge {

/// Time between two log lines about something that is still waited for [ns].
inline constexpr std::int64_t kReminderNs = 60'000'000'000;

/// Steady clock of this process [ns]: for durations; only isobard's messages are on the robot clock.
inline std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace isobar::bridge
