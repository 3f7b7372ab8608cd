// SPDX-License-Identifier: BSD-3-Clause
#include "core/time/clock_anchor.hpp"

#include <algorithm>

#include "core/plausibility.hpp"

namespace isobar {
namespace {

/// Denominator of parts per million.
constexpr std::int64_t kMillion = 1'000'000;

/// Smallest difference between two readings of a clock that wraps.
std::int64_t wrapped_difference(std::int64_t to_ns, std::int64_t from_ns, std::int64_t period_ns) {
  const std::int64_t difference = to_ns - from_ns;
  if (period_ns == 0) {
    return difference;
  }
  std::int64_t rest = difference % period_ns;
  if (rest >= period_ns / 2) {
    rest -= period_ns;
  } else if (rest < -period_ns / 2) {
    rest += period_ns;
  }
  return rest;
}

bool within(std::int64_t a, std::int64_t b, std::int64_t limit) { return (a > b ? a - b : b - a) <= limit; }

}  // namespace

ClockAnchor::ClockAnchor(const ClockAnchorConfig& config) : config_(config) {}

ClockAnchor::Finding ClockAnchor::add(std::int64_t device_ns, std::int64_t host_ns) {
  // Clamped so that differences cannot overflow.
  host_ns = std::clamp(host_ns, kPlausibleStampLowestNs, kPlausibleStampHighestNs);
  if (!anchored_) {
    return first(device_ns, host_ns);
  }
  device_ns_ += wrapped_difference(device_ns, raw_ns_, config_.period_ns);
  raw_ns_ = device_ns;
  const std::int64_t difference_ns = host_ns - device_ns_;
  const std::int64_t elapsed_ns = device_ns_ - newest_ns_;
  const std::int64_t host_elapsed_ns = host_ns - newest_host_ns_;

  if (!within(difference_ns, offset_ns_, config_.step_threshold_ns)) {
    const bool device_regular = elapsed_ns > 0 && elapsed_ns <= config_.max_cadence_ns;
    const bool device_close = elapsed_ns > -config_.max_cadence_ns && elapsed_ns <= config_.max_cadence_ns;
    const bool host_regular = host_elapsed_ns >= 0 && host_elapsed_ns <= config_.max_cadence_ns;
    if (!device_close && host_regular) {
      return re_anchor(difference_ns, host_ns);  // only the device's clock stepped
    }
    return suspect(difference_ns, host_ns, device_regular);
  }
  candidate_samples_ = 0;
  if (elapsed_ns < 0) {
    follow(difference_ns, 0);
    return Finding::kBackward;
  }
  follow(difference_ns, elapsed_ns);
  newest_ns_ = device_ns_;
  newest_host_ns_ = host_ns;
  return Finding::kContinuous;
}

std::int64_t ClockAnchor::device_ahead_ns() const {
  return wrapped_difference(0, offset_ns_, config_.period_ns);
}

ClockAnchor::Finding ClockAnchor::first(std::int64_t device_ns, std::int64_t host_ns) {
  anchored_ = true;
  raw_ns_ = device_ns;
  device_ns_ = device_ns;
  newest_ns_ = device_ns;
  newest_host_ns_ = host_ns;
  offset_ns_ = host_ns - device_ns;
  return Finding::kFirst;
}

ClockAnchor::Finding ClockAnchor::re_anchor(std::int64_t offset_ns, std::int64_t host_ns) {
  offset_ns_ = offset_ns;
  newest_ns_ = device_ns_;
  newest_host_ns_ = host_ns;
  candidate_samples_ = 0;
  early_samples_ = 0;
  ++steps_;
  return Finding::kStep;
}

ClockAnchor::Finding ClockAnchor::suspect(std::int64_t difference_ns, std::int64_t host_ns,
                                          bool device_regular) {
  const bool agrees = candidate_samples_ > 0 &&
                      within(difference_ns, candidate_low_ns_, config_.step_threshold_ns) &&
                      within(difference_ns, candidate_high_ns_, config_.step_threshold_ns);
  if (!agrees) {
    candidate_samples_ = 0;
    candidate_low_ns_ = difference_ns;
    candidate_high_ns_ = difference_ns;
    candidate_device_ns_ = device_ns_;
    candidate_host_ns_ = host_ns;
    // A transport delay makes samples late, never early, and leaves the device's stamps regular.
    candidate_is_delay_ = difference_ns > offset_ns_ && device_regular;
  }
  ++candidate_samples_;
  candidate_low_ns_ = std::min(candidate_low_ns_, difference_ns);
  candidate_high_ns_ = std::max(candidate_high_ns_, difference_ns);
  const bool lasted = device_ns_ - candidate_device_ns_ >= config_.confirm_ns &&
                      host_ns - candidate_host_ns_ >= config_.confirm_ns;
  if (lasted || (!candidate_is_delay_ && candidate_samples_ >= config_.confirm_samples)) {
    return re_anchor(candidate_low_ns_, host_ns);
  }
  if (device_regular) {
    // The device is regular: take its host time from the kept offset.
    newest_ns_ = device_ns_;
    newest_host_ns_ = device_ns_ + offset_ns_;
  }
  return Finding::kHostSuspect;
}

void ClockAnchor::follow(std::int64_t difference_ns, std::int64_t elapsed_ns) {
  drift_rest_ += elapsed_ns * config_.max_drift_ppm;
  offset_ns_ += drift_rest_ / kMillion;
  drift_rest_ %= kMillion;
  if (difference_ns >= offset_ns_) {
    early_samples_ = 0;
    return;
  }
  if (within(difference_ns, offset_ns_, config_.max_early_ns)) {
    offset_ns_ = difference_ns;
    early_samples_ = 0;
    return;
  }
  early_highest_ns_ = early_samples_ == 0 ? difference_ns : std::max(early_highest_ns_, difference_ns);
  if (++early_samples_ >= config_.confirm_samples) {
    offset_ns_ = early_highest_ns_;
    early_samples_ = 0;
  }
}

}  // namespace isobar
