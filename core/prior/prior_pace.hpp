// SPDX-License-Identifier: BSD-3-Clause
// Times of the priors of a robot without an IMU, whose samples would be their clock.
#pragma once

#include <cstdint>

#include "core/stamp.hpp"

namespace isobar {

/// One prior every 20 ms: a robot that turns with 1 rad/s and 5 rad/s^2 has turned 1 mrad further in the middle than the
/// line between two of them.
///
///     while (pace.next(now_ns, stamp_ns)) estimator.advance(stamp_ns, prior);
class PriorPace {
 public:
  static constexpr std::int64_t kStepNs = 20'000'000;
  /// Longest pause that is filled; after a longer one, or a clock set back by as much, the pace begins anew.
  static constexpr std::int64_t kLongestPauseNs = 1'000'000'000;

  /// True, and the stamp of the next prior in `stamp_ns`, while one is due at `now_ns`, robot clock.
  bool next(std::int64_t now_ns, std::int64_t& stamp_ns) {
    if (!plausible_stamp(now_ns)) return false;
    const bool follows =
        started_ && now_ns - last_ns_ <= kLongestPauseNs && last_ns_ - now_ns <= kLongestPauseNs;
    if (follows && now_ns - last_ns_ < kStepNs) return false;
    started_ = true;
    last_ns_ = follows ? last_ns_ + kStepNs : now_ns;
    stamp_ns = last_ns_;
    return true;
  }

 private:
  bool started_ = false;  // stamps of a recording may begin at 0
  std::int64_t last_ns_ = 0;
};

}  // namespace isobar
