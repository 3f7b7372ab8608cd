// SPDX-License-Identifier: BSD-3-Clause
// The system clock beside the robot clock, which never jumps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// One reading of both clocks.
struct ClockPair {
  std::int64_t monotonic_ns = 0;  ///< CLOCK_MONOTONIC
  std::int64_t system_ns = 0;     ///< CLOCK_REALTIME, the time of day
  std::int64_t apart_ns = 0;      ///< upper bound of the time between the two readings
};

/// Follows the system clock, from readings of both clocks, and finds the moments at which it was set.
///
/// The robot clock is CLOCK_MONOTONIC plus a constant. NTP's rate corrections reach both clocks alike, so their
/// difference changes only when somebody sets the system clock. A difference below kStepNs is followed at
/// kSlewPpm, so that stamps on the system clock never descend by it; a larger one is a step, followed at once.
/// One thread.
class SystemClockWatch {
 public:
  /// Smallest change that is a step [ns]: half a scan at 10 Hz, beyond which consumers notice.
  static constexpr std::int64_t kStepNs = 50'000'000;
  /// Rate at which a smaller change is followed [1e-6]: the largest slew of the kernel's adjtime(3).
  static constexpr std::int64_t kSlewPpm = 500;
  /// Steps that are remembered, for the stamps of senders.
  static constexpr std::size_t kRemembered = 8;

  /// @param robot_offset_ns robot clock minus CLOCK_MONOTONIC
  explicit SystemClockWatch(std::int64_t robot_offset_ns) noexcept : robot_offset_ns_(robot_offset_ns) {}

  /// Takes a reading; readings whose clocks were read too far apart are ignored.
  /// @return the step that it shows [ns], negative: set back; 0: none
  std::int64_t note(const ClockPair& now) noexcept;

  /// System clock minus robot clock, without steps smaller than kStepNs [ns]. Added to a stamp it gives the
  /// time of day.
  [[nodiscard]] std::int64_t ahead_ns() const noexcept { return ahead_ns_; }
  /// Steps since the first reading.
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }
  [[nodiscard]] std::int64_t last_step_ns() const noexcept { return last_step_ns_; }
  /// Robot clock at the reading that showed the last step; 0: none.
  [[nodiscard]] std::int64_t stepped_ns() const noexcept { return stepped_ns_; }

  /// Change of the difference at the last reading that showed one, by more than the error of a reading [ns].
  [[nodiscard]] std::int64_t last_change_ns() const noexcept { return change_ns_; }
  /// CLOCK_MONOTONIC of that reading.
  [[nodiscard]] std::int64_t changed_monotonic_ns() const noexcept { return changed_ns_; }

  /// Sums of all steps after each of the newest ones, oldest first; the last one is the sum of all.
  [[nodiscard]] const std::array<std::int64_t, kRemembered>& sums() const noexcept { return sums_; }

 private:
  std::int64_t robot_offset_ns_;
  bool started_ = false;
  std::int64_t difference_ns_ = 0;  // system minus monotonic, last reading
  std::int64_t read_ns_ = 0;        // monotonic, last reading
  std::int64_t ahead_ns_ = 0;
  std::int64_t change_ns_ = 0;
  std::int64_t changed_ns_ = 0;
  std::uint64_t steps_ = 0;
  std::int64_t last_step_ns_ = 0;
  std::int64_t stepped_ns_ = 0;
  std::array<std::int64_t, kRemembered> sums_{};
};

/// Takes the steps of this machine's system clock out of the stamps of a sender that stamps by that clock, so
/// that its stream continues and nobody holds the sender's clock for set. A sender with a clock of its own
/// passes unchanged: which one it is shows after each step, by the stamp that continues the stream.
class SenderClock {
 public:
  /// @param stamp_ns stamp on the sender's clock
  /// @param expected_ns stamp, as returned by this function, that would continue the stream
  /// @param continues false for the first sample of a stream: expected_ns is not used
  [[nodiscard]] std::int64_t without_steps_ns(std::int64_t stamp_ns, std::int64_t expected_ns, bool continues,
                                              const SystemClockWatch& system) noexcept;

 private:
  std::int64_t shared_ns_ = 0;  // steps that this sender's clock has made with the system clock
};

}  // namespace isobar
