// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/robot_air.hpp"

#include <algorithm>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

void RobotAir::add(std::int64_t stamp_ns, double log_pa, double climb_m) {
  if (count_ > 0 && seconds_between(entry(count_ - 1).stamp_ns, stamp_ns) < kSpacingS) return;
  entries_[next_] = {stamp_ns, log_pa, climb_m};
  next_ = (next_ + 1) % kEntries;
  count_ = std::min(count_ + 1, kEntries);
}

RobotAir::Value RobotAir::at(std::int64_t stamp_ns) const {
  // Backwards from the newest: a base station's sample is seldom old.
  std::size_t after = count_ - 1;
  while (after > 0 && entry(after - 1).stamp_ns >= stamp_ns) --after;
  const Entry& late = entry(after);
  if (after == 0 || late.stamp_ns <= stamp_ns) return {late.log_pa, late.climb_m, 1.0};
  const Entry& early = entry(after - 1);
  const double share =
      seconds_between(early.stamp_ns, stamp_ns) / seconds_between(early.stamp_ns, late.stamp_ns);
  return {early.log_pa + share * (late.log_pa - early.log_pa),
          early.climb_m + share * (late.climb_m - early.climb_m), squared(1.0 - share) + squared(share)};
}

}  // namespace isobar
