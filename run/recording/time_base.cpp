// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/time_base.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace isobar::recording {
namespace {

// Within a turn of any lidar all streams have come to a jump, but for those slower than it. So far apart may be the time of
// a packet and its stamp, too, where the sensor sees a part of the turn only and a packet begins before the rest.
constexpr std::int64_t kOneTurnNs = 250'000'000;
// Streams with longer intervals are not waited for.
constexpr std::int64_t kSlowIntervalNs = 2'000'000'000;
// A jump forward is longer than so many intervals.
constexpr std::int64_t kGapIntervals = 4;
// After a step of the clock alone a sensor's own clock has gone on by less.
constexpr std::int64_t kNoPauseNs = 1'000'000'000;

}  // namespace

std::int64_t TimeBase::State::interval_ns() const {
  const std::size_t count = std::min(interval_count, kIntervals);
  if (count == 0) return 0;
  std::array<std::int64_t, kIntervals> sorted = intervals_ns;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

TimeBase::TimeBase(const std::vector<Stream>& streams) {
  for (const Stream& stream : streams) {
    streams_.emplace_back();
    streams_.back().stream = stream;
  }
}

void TimeBase::take(std::size_t stream, std::int64_t raw_ns, const Elapsed& elapsed) {
  State& state = streams_[stream];
  if (state.alive) {
    state.has_last = true;
    state.last_raw_ns = state.raw_ns;
    state.last_ns = state.next_ns();
  }
  state.alive = true;
  state.raw_ns = raw_ns;
  if (!state.has_last) return;
  const std::int64_t jump_ns = state.jump_ns();
  const bool forward =
      jump_ns > kLeastForwardNs && state.interval_count > 0 && jump_ns > kGapIntervals * state.interval_ns();
  if (jump_ns < -kLeastBackNs || forward) {
    state.waiting = true;
    state.elapsed_ns = elapsed ? elapsed() : std::nullopt;
  } else if (jump_ns > 0) {
    state.intervals_ns[state.interval_count++ % kIntervals] = jump_ns;
  }
}

void TimeBase::end(std::size_t stream) {
  streams_[stream].alive = false;
  streams_[stream].waiting = false;
}

std::optional<std::size_t> TimeBase::choose() {
  for (;;) {
    std::optional<std::size_t> next;
    std::optional<std::int64_t> newest_ns;  // before the jump, of the streams that wait
    for (std::size_t k = 0; k < streams_.size(); ++k) {
      const State& state = streams_[k];
      if (!state.alive) continue;
      if (state.waiting) {
        newest_ns = std::max(newest_ns.value_or(state.last_ns), state.last_ns);
      } else if (!next || state.next_ns() < streams_[*next].next_ns()) {
        next = k;
      }
    }
    if (!newest_ns) return next;
    if (!all_have_come_to_the_jump(*newest_ns)) return next;
    start_anew(*newest_ns);
  }
}

/// True for a stream with intervals too long to show a jump of this size.
bool TimeBase::cannot_show(const State& state, std::int64_t jump_ns) {
  return state.interval_ns() + 2 * kLeastBackNs >= std::abs(jump_ns);
}

/// True when no stream can come to the same jump any more: it waits, or goes on past it.
bool TimeBase::all_have_come_to_the_jump(std::int64_t newest_ns) const {
  std::int64_t jump_ns = std::numeric_limits<std::int64_t>::max();
  for (const State& state : streams_) {
    if (state.waiting) jump_ns = std::min(jump_ns, std::abs(state.jump_ns()));
  }
  return std::all_of(streams_.begin(), streams_.end(), [&](const State& state) {
    if (!state.alive || state.waiting) return true;
    const std::int64_t interval_ns = state.interval_ns();
    const bool slow = interval_ns > kSlowIntervalNs || cannot_show(state, jump_ns);
    const std::int64_t patience_ns = slow ? 0 : kOneTurnNs + interval_ns * 3 / 2;
    return state.next_ns() > newest_ns + patience_ns;
  });
}

/// The shift by which the sensor's own clock makes its time go on; nothing when it cannot tell, the old one after a pause.
std::optional<std::int64_t> TimeBase::shift_by_own_clock_ns(const State& state) const {
  if (!state.elapsed_ns) return std::nullopt;
  const std::int64_t elapsed_ns = *state.elapsed_ns;
  std::int64_t difference_ns = state.jump_ns() - elapsed_ns;
  const bool forward = state.jump_ns() > 0;
  if (forward && std::abs(difference_ns) <= kOneTurnNs) return state.shift_ns;
  const std::int64_t period_ns = state.stream.period_ns;
  // A pause of more than a period looks like a shorter one, a step by whole periods like none.
  if (forward && period_ns > 0 && elapsed_ns > kNoPauseNs) {
    difference_ns %= period_ns;
    if (difference_ns <= kOneTurnNs || period_ns - difference_ns <= kOneTurnNs) return state.shift_ns;
  }
  return state.last_ns + elapsed_ns - state.raw_ns;
}

std::optional<std::int64_t> TimeBase::common_shift_ns() const {
  std::optional<std::int64_t> own_ns;
  for (const State& state : streams_) {
    if (state.waiting && !own_ns) own_ns = shift_by_own_clock_ns(state);
  }
  std::optional<std::int64_t> shift_ns = own_ns;
  for (const State& state : streams_) {
    if (!state.waiting) continue;
    // Each stream's first sample comes one interval after its last, or later where samples were lost.
    const std::int64_t least_ns = state.last_ns + state.interval_ns() - state.raw_ns;
    const bool believed = own_ns ? std::abs(least_ns - *own_ns) <= kOneTurnNs : state.jump_ns() < 0;
    if (believed) shift_ns = std::max(shift_ns.value_or(least_ns), least_ns);
  }
  return shift_ns;
}

/// The common shift where it makes the stream's time go on, else its own.
std::int64_t TimeBase::shift_of(const State& state, std::optional<std::int64_t> common_ns) const {
  const auto goes_on = [&](std::int64_t shift_ns) {
    const std::int64_t step_ns = state.raw_ns + shift_ns - state.last_ns;
    return step_ns > -kLeastBackNs && step_ns <= kLeastForwardNs + kGapIntervals * state.interval_ns();
  };
  if (last_shift_ns_ && goes_on(*last_shift_ns_)) return *last_shift_ns_;
  if (common_ns && goes_on(*common_ns)) return *common_ns;
  if (state.jump_ns() > 0) return state.shift_ns;  // a pause of its own
  return state.last_ns + state.interval_ns() - state.raw_ns;
}

void TimeBase::start_anew(std::int64_t newest_ns) {
  const std::optional<std::int64_t> common_ns = common_shift_ns();
  std::optional<std::int64_t> change_ns;
  for (State& state : streams_) {
    if (!state.waiting) continue;
    const std::int64_t shift_ns = shift_of(state, common_ns);
    if (shift_ns != state.shift_ns && !change_ns) change_ns = shift_ns - state.shift_ns;
    if (shift_ns != state.shift_ns && (shift_ns == common_ns || !last_shift_ns_)) last_shift_ns_ = shift_ns;
    state.shift_ns = shift_ns;
    state.waiting = false;
  }
  if (!change_ns) return;
  if (steps_++ == 0) {
    first_step_ns_ = -*change_ns;
    first_step_at_ns_ = newest_ns;
  }
  move_slow_streams(*change_ns);
}

/// Streams of the same clock that are too slow to show the step.
void TimeBase::move_slow_streams(std::int64_t change_ns) {
  for (State& state : streams_) {
    if (state.alive && cannot_show(state, change_ns) && state.stream.robot_clock &&
        state.shift_ns != last_shift_ns_)
      state.shift_ns += change_ns;
  }
}

}  // namespace isobar::recording
