// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace isobar::recording {

/// Merges the streams of a recording into the order of one time that never jumps, though the clock that stamped them did.
///
/// A stream whose stamps jump (confirmed by a second sample before they come here) waits until the others have jumped, too, or
/// have gone on without a jump, being stamped by another clock. Then all that wait start a new time base together: their
/// time goes on where it was. How long the jump took is told by the lidar's own clock; without it, a clock that was set
/// back is taken to have lost no time, and a jump forward is taken as a pause of the recorder, which nothing contradicts.
class TimeBase {
 public:
  /// Smallest step back of a clock; stamps that are older by less came late.
  static constexpr std::int64_t kLeastBackNs = 50'000'000;
  /// Smallest step forward, unless the stream is slower.
  static constexpr std::int64_t kLeastForwardNs = 2'000'000'000;

  struct Stream {
    bool robot_clock = true;     ///< false: the base station's own clock
    std::int64_t period_ns = 0;  ///< of the own clock of its sensor; 0: it does not wrap, or has none
  };
  explicit TimeBase(const std::vector<Stream>& streams);

  /// Time between the previous event and this one on the sensor's own clock; asked for at a jump only.
  using Elapsed = std::function<std::optional<std::int64_t>()>;
  /// Takes the stamp of a stream's next event.
  void take(std::size_t stream, std::int64_t raw_ns, const Elapsed& elapsed);
  /// A stream has no more events.
  void end(std::size_t stream);
  /// The stream whose event comes next, the first one among equals; nothing when all have ended.
  std::optional<std::size_t> choose();
  /// What to add to the stamp of a stream's next event [ns].
  [[nodiscard]] std::int64_t shift_ns(std::size_t stream) const { return streams_[stream].shift_ns; }

  /// Steps of the clock that were taken out, and the first one: positive: it was set forward.
  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  [[nodiscard]] std::int64_t first_step_ns() const { return first_step_ns_; }
  /// When, in the time of the first time base.
  [[nodiscard]] std::int64_t first_step_at_ns() const { return first_step_at_ns_; }

 private:
  static constexpr std::size_t kIntervals = 15;

  struct State {
    Stream stream;
    bool alive = false;
    bool waiting = false;
    std::int64_t raw_ns = 0;  // of the next event
    std::int64_t shift_ns = 0;
    bool has_last = false;
    std::int64_t last_raw_ns = 0;            // of the event before
    std::int64_t last_ns = 0;                // the same in the merged time
    std::optional<std::int64_t> elapsed_ns;  // on the sensor's own clock, at a jump
    std::array<std::int64_t, kIntervals> intervals_ns{};
    std::size_t interval_count = 0;

    [[nodiscard]] std::int64_t next_ns() const { return raw_ns + shift_ns; }
    [[nodiscard]] std::int64_t jump_ns() const { return raw_ns - last_raw_ns; }
    [[nodiscard]] std::int64_t interval_ns() const;  // median of the last
  };

  [[nodiscard]] static bool cannot_show(const State& state, std::int64_t jump_ns);
  [[nodiscard]] bool all_have_come_to_the_jump(std::int64_t newest_ns) const;
  void start_anew(std::int64_t newest_ns);
  [[nodiscard]] std::optional<std::int64_t> common_shift_ns() const;
  [[nodiscard]] std::optional<std::int64_t> shift_by_own_clock_ns(const State& state) const;
  [[nodiscard]] std::int64_t shift_of(const State& state, std::optional<std::int64_t> common_ns) const;
  void move_slow_streams(std::int64_t change_ns);

  std::vector<State> streams_;
  std::optional<std::int64_t> last_shift_ns_;  // of the newest time base
  std::uint64_t steps_ = 0;
  std::int64_t first_step_ns_ = 0;
  std::int64_t first_step_at_ns_ = 0;
};

}  // namespace isobar::recording
