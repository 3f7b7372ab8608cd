// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/stamp.hpp"

namespace isobar {

/// First and last stamp of a stream, its rate and its gaps. Trivially copyable.
class StreamTimes {
 public:
  /// A gap: five mean intervals, and at least 0.1 s.
  static constexpr int kGapIntervals = 5;
  static constexpr std::int64_t kLeastGapNs = 100'000'000;

  void add(std::int64_t stamp_ns) {
    if (count_ == 0) {
      first_ns_ = last_ns_ = before_ns_ = stamp_ns;
    }
    const std::int64_t interval_ns = stamp_ns - before_ns_;
    const std::int64_t mean_ns =
        count_ > 1 ? (before_ns_ - first_ns_) / static_cast<std::int64_t>(count_ - 1) : 0;
    if (count_ > 1 && interval_ns > std::max(kLeastGapNs, kGapIntervals * mean_ns)) ++gaps_;
    longest_gap_ns_ = std::max(longest_gap_ns_, interval_ns);
    before_ns_ = stamp_ns;
    first_ns_ = std::min(first_ns_, stamp_ns);
    last_ns_ = std::max(last_ns_, stamp_ns);
    ++count_;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t first_ns() const { return first_ns_; }
  [[nodiscard]] std::int64_t last_ns() const { return last_ns_; }
  [[nodiscard]] double length_s() const { return seconds_between(first_ns_, last_ns_); }
  [[nodiscard]] double rate_hz() const {
    return count_ > 1 && last_ns_ > first_ns_ ? static_cast<double>(count_ - 1) / length_s() : 0.0;
  }
  [[nodiscard]] std::uint64_t gaps() const { return gaps_; }
  [[nodiscard]] double longest_gap_s() const { return seconds_between(0, longest_gap_ns_); }

 private:
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t before_ns_ = 0;
  std::int64_t longest_gap_ns_ = 0;
  std::uint64_t count_ = 0;
  std::uint64_t gaps_ = 0;
};

/// Time that both streams cover [s]; negative: the pause between them.
inline double overlap_s(const StreamTimes& a, const StreamTimes& b) {
  return seconds_between(std::max(a.first_ns(), b.first_ns()), std::min(a.last_ns(), b.last_ns()));
}

}  // namespace isobar
