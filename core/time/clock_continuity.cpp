// SPDX-License-Identifier: BSD-3-Clause
#include "core/time/clock_continuity.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/plausibility.hpp"

namespace isobar {

bool ClockContinuity::add(std::int64_t device_ns, std::int64_t host_ns) noexcept {
  // Clamped so that differences cannot overflow.
  device_ns = std::clamp(device_ns, kPlausibleStampLowestNs, kPlausibleStampHighestNs);
  host_ns = std::clamp(host_ns, kPlausibleStampLowestNs, kPlausibleStampHighestNs);
  if (!started_) {
    begin(device_ns, host_ns);
    return false;
  }
  const std::int64_t step_ns = wrapped(device_ns - newest_ns_);
  const std::int64_t elapsed_ns = host_ns - std::min(offset_ns_, last_offset_ns_) - unwrapped_ns_;
  const bool paused = host_ns - heard_ns_ >= kPauseNs;
  heard_ns_ = host_ns;
  if (is_explained(step_ns, elapsed_ns, kToleranceNs)) {
    advance(device_ns, step_ns, elapsed_ns);
    follow_offset(host_ns - unwrapped_ns_, host_ns);
    return false;
  }
  if (break_.pending() && std::abs(wrapped(device_ns - break_newest_ns_)) > kToleranceNs) break_.clear();
  if (!break_.pending()) break_after_pause_ = paused;
  break_newest_ns_ = device_ns;
  if (!break_.broken(host_ns)) return false;
  // One wrong stamp must not move the clock, hence no standstill is believed before it has lasted.
  const bool is_jump = !is_explained(step_ns, elapsed_ns, kStandstillNs);
  if (is_jump) after_pause_ = break_after_pause_;
  begin(device_ns, host_ns);
  return is_jump;
}

/// The difference itself, or the smallest one that an unknown number of periods leaves.
std::int64_t ClockContinuity::wrapped(std::int64_t difference_ns) const noexcept {
  if (period_ns_ == 0) return difference_ns;
  const std::int64_t rest_ns = difference_ns % period_ns_;
  if (rest_ns >= period_ns_ / 2) return rest_ns - period_ns_;
  return rest_ns < -period_ns_ / 2 ? rest_ns + period_ns_ : rest_ns;
}

bool ClockContinuity::is_explained(std::int64_t step_ns, std::int64_t elapsed_ns,
                                   std::int64_t ahead_ns) const noexcept {
  if (elapsed_ns > kSilenceNs) {
    return has_stood(step_ns) || std::abs(wrapped(step_ns - elapsed_ns)) <= kStandstillNs;
  }
  return step_ns >= -kToleranceNs && step_ns <= std::max<std::int64_t>(0, elapsed_ns) + ahead_ns;
}

void ClockContinuity::advance(std::int64_t device_ns, std::int64_t step_ns,
                              std::int64_t elapsed_ns) noexcept {
  break_.clear();
  const bool went_on = elapsed_ns > kSilenceNs && !has_stood(step_ns);
  if (!went_on && step_ns <= 0) return;  // overtaken
  unwrapped_ns_ += went_on ? elapsed_ns + wrapped(step_ns - elapsed_ns) : step_ns;
  newest_ns_ = device_ns;
}

void ClockContinuity::begin(std::int64_t device_ns, std::int64_t host_ns) noexcept {
  started_ = true;
  newest_ns_ = device_ns;
  unwrapped_ns_ = device_ns;
  heard_ns_ = host_ns;
  offset_ns_ = host_ns - device_ns;
  last_offset_ns_ = offset_ns_;
  minute_began_ns_ = host_ns;
  break_.clear();
}

// Two successive minima: drift and a player that has paused are forgotten after one to two minutes.
void ClockContinuity::follow_offset(std::int64_t offset_ns, std::int64_t host_ns) noexcept {
  constexpr std::int64_t kMinuteNs = 60'000'000'000;
  if (host_ns - minute_began_ns_ >= kMinuteNs) {
    last_offset_ns_ = offset_ns_;
    offset_ns_ = offset_ns;
    minute_began_ns_ = host_ns;
  }
  offset_ns_ = std::min(offset_ns_, offset_ns);
}

}  // namespace isobar
