// SPDX-License-Identifier: BSD-3-Clause
// Continuity of a stream: whether its samples go on, or begin anew.
#pragma once

#include <cstdint>

namespace isobar {

/// Confirms a break by the samples after it. A bunch of old samples that overtakes, or is overtaken by, new ones
/// is over within a fraction of kLastingNs.
class LastingBreak {
 public:
  /// Least duration of a break on the robot clock [ns], and least number of its samples.
  static constexpr std::int64_t kLastingNs = 300'000'000;
  static constexpr int kSamples = 4;

  /// @param now_ns arrival of a sample that does not continue the stream, robot clock
  /// @return true when the break has lasted
  bool broken(std::int64_t now_ns) noexcept {
    if (samples_++ == 0) began_ns_ = now_ns;
    return samples_ >= kSamples && now_ns - began_ns_ >= kLastingNs;
  }
  /// A sample continues the stream.
  void clear() noexcept { samples_ = 0; }
  [[nodiscard]] bool pending() const noexcept { return samples_ > 0; }

 private:
  int samples_ = 0;
  std::int64_t began_ns_ = 0;
};

/// Finds jumps of a sensor's clock that elapsed time cannot explain: the sensor was started again, its clock was
/// set, or a recording is played from another moment on.
///
/// Not a jump: sensor, sender and network may stand still, deliver late and in a bunch, or lose what was sent, so
/// the clock may advance by anything between nothing and the time elapsed since its last sample. This machine
/// may stand still together with its own clock (a virtual machine, a suspended computer), so it may advance by
/// kStandstillNs more. After a silence beyond kSilenceNs an hourly clock may have wrapped any number of times: it
/// must then have advanced by nothing or by the elapsed time, each within kStandstillNs.
///
/// Unlike ClockAnchor, which maps stamps and re-anchors after every lasting change of the delay, too. Integer
/// arithmetic only; one thread.
class ClockContinuity {
 public:
  /// Largest step backward of a sample overtaken in transport, and largest error of the elapsed time [ns].
  static constexpr std::int64_t kToleranceNs = 1'000'000'000;
  static constexpr std::int64_t kStandstillNs = 30'000'000'000;
  static constexpr std::int64_t kSilenceNs = 60'000'000'000;
  /// Silence before a stream that begins anew [ns]: a player needs longer to start, a clock is set without one.
  static constexpr std::int64_t kPauseNs = 100'000'000;

  /// @param period_ns period after which the clock wraps to 0 [ns]; 0: never
  explicit ClockContinuity(std::int64_t period_ns = 0) noexcept : period_ns_(period_ns) {}

  /// Takes one sample.
  /// @param device_ns its stamp on the sensor's clock, plausible
  /// @param host_ns its arrival, robot clock: late by any time, never early
  /// @return true once for each jump, when it has lasted
  bool add(std::int64_t device_ns, std::int64_t host_ns) noexcept;

  /// The last jump came after a silence of kPauseNs or longer.
  [[nodiscard]] bool jumped_after_pause() const noexcept { return after_pause_; }

 private:
  [[nodiscard]] std::int64_t wrapped(std::int64_t difference_ns) const noexcept;
  /// @param ahead_ns by how much the clock may have advanced more than the elapsed time
  [[nodiscard]] bool is_explained(std::int64_t step_ns, std::int64_t elapsed_ns,
                                  std::int64_t ahead_ns) const noexcept;
  [[nodiscard]] static bool has_stood(std::int64_t step_ns) noexcept {
    return step_ns >= -kToleranceNs && step_ns <= kStandstillNs;
  }
  void advance(std::int64_t device_ns, std::int64_t step_ns, std::int64_t elapsed_ns) noexcept;
  void begin(std::int64_t device_ns, std::int64_t host_ns) noexcept;
  void follow_offset(std::int64_t offset_ns, std::int64_t host_ns) noexcept;

  std::int64_t period_ns_;
  bool started_ = false;
  std::int64_t newest_ns_ = 0;     // newest device stamp of the stream
  std::int64_t unwrapped_ns_ = 0;  // the same, unwrapped
  std::int64_t heard_ns_ = 0;      // last arrival
  // Smallest host minus unwrapped device stamp of this and the last minute: the arrivals with the least delay.
  std::int64_t offset_ns_ = 0;
  std::int64_t last_offset_ns_ = 0;
  std::int64_t minute_began_ns_ = 0;
  LastingBreak break_;
  std::int64_t break_newest_ns_ = 0;  // device stamp of the last sample after the break
  bool break_after_pause_ = false;
  bool after_pause_ = false;
};

/// Finds that the numbers of a stream's samples begin anew: its sender was started again. One thread.
class NumberContinuity {
 public:
  /// Largest step backward of a sample overtaken in transport.
  static constexpr std::int32_t kReorder = 64;

  /// @param number of the sample, wraps
  /// @param host_ns its arrival, robot clock
  /// @return true once for each new beginning, when it has lasted
  bool add(std::uint32_t number, std::int64_t host_ns) noexcept {
    // Serial number arithmetic (RFC 1982).
    const auto ahead = static_cast<std::int32_t>(number - newest_);
    if (!started_ || ahead >= -kReorder) {
      if (!started_ || ahead > 0) newest_ = number;
      started_ = true;
      break_.clear();
      return false;
    }
    if (!break_.broken(host_ns)) return false;
    newest_ = number;
    break_.clear();
    return true;
  }

 private:
  bool started_ = false;
  std::uint32_t newest_ = 0;
  LastingBreak break_;
};

}  // namespace isobar
