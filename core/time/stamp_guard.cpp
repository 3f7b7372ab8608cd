// SPDX-License-Identifier: BSD-3-Clause
#include "core/time/stamp_guard.hpp"

#include <algorithm>

namespace isobar {
namespace {

/// Longest step that can be the interval of a slow stream.
constexpr std::int64_t kSlowestCadenceNs = 600'000'000'000;

}  // namespace

bool StampGuard::usual(std::int64_t from_ns, std::int64_t to_ns) const {
  return to_ns - from_ns <= max_forward_ns_ && from_ns - to_ns <= max_reorder_ns_;
}

StampVerdict StampGuard::check(std::int64_t stamp_ns) {
  if (!started_) {
    started_ = true;
    newest_ns_ = stamp_ns;
    return StampVerdict::kAccept;
  }
  if (usual(newest_ns_, stamp_ns)) {
    absurd_ += holding_ ? 1 : 0;
    holding_ = false;
    if (stamp_ns == newest_ns_) {
      ++duplicates_;
      return StampVerdict::kDuplicate;
    }
    if (stamp_ns < newest_ns_) {
      ++reordered_;
      return StampVerdict::kReordered;
    }
    newest_ns_ = stamp_ns;
    return StampVerdict::kAccept;
  }
  if (holding_ && stamp_ns == held_ns_) {
    ++duplicates_;  // a copy does not confirm the held sample
    return StampVerdict::kHeld;
  }
  if (holding_) {
    // A stream slower than max_forward_ns: successive steps of similar length.
    const std::int64_t held_step_ns = held_ns_ - newest_ns_;
    const std::int64_t step_ns = stamp_ns - held_ns_;
    const bool slow =
        step_ns > 0 && step_ns <= kSlowestCadenceNs && held_step_ns > 0 && step_ns / 2 <= held_step_ns;
    if (slow || usual(held_ns_, stamp_ns)) {
      return confirm(stamp_ns);
    }
    ++absurd_;
  }
  holding_ = true;
  held_ns_ = stamp_ns;
  return StampVerdict::kHeld;
}

StampVerdict StampGuard::confirm(std::int64_t stamp_ns) {
  holding_ = false;
  if (held_ns_ > newest_ns_) {
    ++gaps_;
  } else {
    ++steps_back_;
  }
  max_forward_ns_ = std::max(max_forward_ns_, 2 * (stamp_ns - held_ns_));
  newest_ns_ = std::max(held_ns_, stamp_ns);
  return StampVerdict::kConfirmed;
}

}  // namespace isobar
