// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/clock/robot_clock.hpp"

namespace isobar {

/// Maps the kernel's receive times, which are on the system clock, to the robot clock, also while the system
/// clock is set. One thread.
class ReceiveClock {
 public:
  /// @param source readings of the clocks
  explicit ReceiveClock(ClockSource source) noexcept;

  /// Robot clock now; looks for a step of the system clock.
  std::int64_t now_ns() noexcept;
  /// @param system_ns receive time of a datagram that was just read; older than a second or in the future
  ///        (stamped before the system clock was set): converts to now_ns()
  /// @return never earlier than the datagram was received: the filters of the senders' clocks forgive late
  ///         receive times, not early ones
  std::int64_t to_robot_ns(std::int64_t system_ns) noexcept;

  [[nodiscard]] const SystemClockWatch& system() const noexcept { return system_; }

 private:
  ClockSource source_;
  SystemClockWatch system_;
};

}  // namespace isobar
