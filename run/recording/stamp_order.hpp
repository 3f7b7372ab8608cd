// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <optional>
#include <utility>

#include "core/time/stamp_guard.hpp"

namespace isobar::recording {

/// Sorts the samples of one file by stamp within a look-ahead of a few rows.
///
/// Dropped: a single absurd stamp; a run of absurd stamps shorter than the look-ahead after which the good
/// stamps continue; samples late by more than the look-ahead, since newer ones were returned already. Samples
/// late by less are sorted in. After a true step back of the clock the stream continues with the new stamps.
template <typename Sample>
class StampOrder {
 public:
  static constexpr std::size_t kLookAhead = 32;
  /// Longest step from the first stamp to the second [ns]; after a longer one the first stamp was absurd.
  static constexpr std::int64_t kMaxFirstStepNs = 3'600'000'000'000;

  /// Most stamps at the start of a file that count as absurd; more are good stamps before a step of the
  /// clock.
  static constexpr std::size_t kMaxAbsurdAtStart = 3;

  struct Counts {
    std::uint64_t duplicates = 0;
    std::uint64_t absurd = 0;
    std::uint64_t too_late = 0;
  };

  explicit StampOrder(const StampGuardConfig& config)
      : guard_(config), max_forward_ns_(config.max_forward_ns) {}

  /// The next sample in order; false at the end.
  /// @param read bool(Sample&): reads the next sample of the file, false at its end
  template <typename Read>
  bool next(Sample& sample, const Read& read) {
    while (!at_end_ && after_step_.empty() && ordered_.size() < kLookAhead) {
      Sample incoming;
      if (read(incoming)) {
        take(std::move(incoming));
      } else {
        at_end_ = true;
        counts_.absurd += held_ ? 1 : 0;
      }
    }
    if (ordered_.empty() && !after_step_.empty()) {
      handed_out_ = false;
      stepped_ = false;
      std::swap(ordered_, after_step_);
    }
    if (ordered_.empty()) {
      return false;
    }
    sample = std::move(ordered_.front());
    ordered_.pop_front();
    handed_out_ = true;
    newest_out_ns_ = sample.stamp_ns;
    return true;
  }

  [[nodiscard]] const StampGuard& guard() const { return guard_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  void take(Sample&& incoming) {
    const std::int64_t before_ns = guard_.newest_ns();
    const StampVerdict verdict = guard_.check(incoming.stamp_ns);
    if (verdict == StampVerdict::kConfirmed) {
      Sample held = std::move(*held_);
      held_.reset();
      if (held.stamp_ns > before_ns) {
        step_forward(held.stamp_ns, before_ns);
      } else {
        step_back(held.stamp_ns);
      }
      insert(std::move(held));
      insert(std::move(incoming));
      return;
    }
    counts_.absurd += held_ ? 1 : 0;
    held_.reset();
    switch (verdict) {
      case StampVerdict::kHeld:
        held_ = std::move(incoming);
        break;
      case StampVerdict::kDuplicate:
        ++counts_.duplicates;
        break;
      default:
        insert(std::move(incoming));
        break;
    }
  }

  void step_forward(std::int64_t to_ns, std::int64_t from_ns) {
    if (!handed_out_ && ordered_.size() == 1 && to_ns - from_ns > kMaxFirstStepNs) {
      ordered_.clear();
      ++counts_.absurd;
    }
  }

  /// A confirmed step back to `to_ns`. If the stamps continue those before it in the look-ahead, the newer
  /// ones were absurd; otherwise the clock was set back.
  void step_back(std::int64_t to_ns) {
    const auto ahead = std::find_if(ordered_.begin(), ordered_.end(),
                                    [to_ns](const Sample& sample) { return sample.stamp_ns > to_ns; });
    const bool nothing_before = ahead == ordered_.begin() && !handed_out_;
    const bool goes_on = nothing_before
                             ? ordered_.size() <= kMaxAbsurdAtStart
                             : (ahead != ordered_.begin() || newest_out_ns_ <= to_ns) && jumps_ahead(ahead);
    if (goes_on) {
      counts_.absurd += static_cast<std::uint64_t>(ordered_.end() - ahead);
      ordered_.erase(ahead, ordered_.end());
    } else {
      stepped_ = true;
    }
  }

  /// Absurd stamps begin with a jump forward; stamps before a step back do not.
  [[nodiscard]] bool jumps_ahead(typename std::deque<Sample>::const_iterator ahead) const {
    if (ahead == ordered_.end()) return true;
    const std::int64_t before_ns = ahead == ordered_.begin() ? newest_out_ns_ : std::prev(ahead)->stamp_ns;
    return ahead->stamp_ns - before_ns > max_forward_ns_;
  }

  void insert(Sample&& sample) {
    if (stepped_ && !ordered_.empty()) {
      after_step_.push_back(std::move(sample));
      return;
    }
    if (stepped_) {
      handed_out_ = false;
    }
    stepped_ = false;
    if (handed_out_ && sample.stamp_ns < newest_out_ns_) {
      ++counts_.too_late;
      return;
    }
    const auto place = std::upper_bound(
        ordered_.begin(), ordered_.end(), sample.stamp_ns,
        [](std::int64_t stamp_ns, const Sample& other) { return stamp_ns < other.stamp_ns; });
    if (place != ordered_.begin() && std::prev(place)->stamp_ns == sample.stamp_ns) {
      ++counts_.duplicates;
      return;
    }
    ordered_.insert(place, std::move(sample));
  }

  StampGuard guard_;
  std::int64_t max_forward_ns_;
  Counts counts_;
  std::deque<Sample> ordered_;     // the look-ahead, by stamp
  std::deque<Sample> after_step_;  // samples after a step back of the clock
  std::optional<Sample> held_;     // its stamp jumped; the next verdict of guard_ decides
  bool stepped_ = false;           // the clock stepped back; ordered_ still holds samples before the step
  bool handed_out_ = false;        // a sample was returned since the start or the last step back
  bool at_end_ = false;
  std::int64_t newest_out_ns_ = 0;
};

}  // namespace isobar::recording
