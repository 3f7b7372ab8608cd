// SPDX-License-Identifier: BSD-3-Clause
#include "core/time/system_clock_watch.hpp"

#include <algorithm>
#include <cstdlib>

namespace isobar {
namespace {

/// Largest time between the readings of the two clocks of a pair that is used; a longer one was interrupted.
constexpr std::int64_t kMaxApartNs = 500'000;
/// Smallest change of the difference that is none of the readings' errors.
constexpr std::int64_t kReadingErrorNs = 1'000'000;
/// Largest error with which a stamp continues a stream across a step: drift and jitter of a stream that paused.
constexpr std::int64_t kMaxErrorNs = 1'000'000'000;

}  // namespace

std::int64_t SystemClockWatch::note(const ClockPair& now) noexcept {
  if (now.apart_ns > kMaxApartNs) return 0;
  const std::int64_t difference_ns = now.system_ns - now.monotonic_ns;
  const std::int64_t target_ns = difference_ns - robot_offset_ns_;
  const std::int64_t elapsed_ns = std::max<std::int64_t>(0, now.monotonic_ns - read_ns_);
  const std::int64_t change_ns = difference_ns - difference_ns_;
  difference_ns_ = difference_ns;
  read_ns_ = now.monotonic_ns;
  if (!started_) {
    started_ = true;
    ahead_ns_ = target_ns;
    return 0;
  }
  if (std::abs(change_ns) > kReadingErrorNs) {
    change_ns_ = change_ns;
    changed_ns_ = now.monotonic_ns;
  }
  const std::int64_t missing_ns = target_ns - ahead_ns_;
  if (std::abs(missing_ns) < kStepNs) {
    const std::int64_t slew_ns = std::min(elapsed_ns, kMaxErrorNs) * kSlewPpm / 1'000'000;
    ahead_ns_ += std::clamp(missing_ns, -slew_ns, slew_ns);
    return 0;
  }
  ahead_ns_ = target_ns;
  ++steps_;
  last_step_ns_ = missing_ns;
  stepped_ns_ = now.monotonic_ns + robot_offset_ns_;
  std::copy(sums_.begin() + 1, sums_.end(), sums_.begin());
  sums_.back() += missing_ns;
  return missing_ns;
}

std::int64_t SenderClock::without_steps_ns(std::int64_t stamp_ns, std::int64_t expected_ns, bool continues,
                                           const SystemClockWatch& system) noexcept {
  if (!continues) {
    shared_ns_ = system.sums().back();
    return stamp_ns - shared_ns_;
  }
  const auto error_ns = [&](std::int64_t sum_ns) { return std::abs(stamp_ns - sum_ns - expected_ns); };
  const std::int64_t now_ns = error_ns(shared_ns_);
  if (now_ns <= SystemClockWatch::kStepNs) return stamp_ns - shared_ns_;
  const std::int64_t best_ns =
      *std::min_element(system.sums().begin(), system.sums().end(),
                        [&](std::int64_t a, std::int64_t b) { return error_ns(a) < error_ns(b); });
  if (error_ns(best_ns) < std::min(kMaxErrorNs, now_ns / 4)) shared_ns_ = best_ns;
  return stamp_ns - shared_ns_;
}

}  // namespace isobar
