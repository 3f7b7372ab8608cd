// SPDX-License-Identifier: BSD-3-Clause
// The last seconds of priors, to be asked for at any time between two of them (deskew, registration).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/estimates.hpp"

namespace isobar {

/// State between two priors, `fraction` of the way (0 … 1): rotation by slerp; translation, height, twist and
/// variances linearly. Flags hold only where both hold; the height source is the worse of the two.
Prior interpolate(const Prior& before, const Prior& after, std::int64_t stamp_ns);

/// Prior carried on to `stamp_ns` at constant twist; the height at `height_rate_m_s`, which is not the
/// twist's where the ground moves (elevator). The height's variance grows with the velocity's.
Prior extrapolate(const Prior& from, std::int64_t stamp_ns, double height_rate_m_s);

/// Ring buffer of fixed capacity, oldest forgotten first. Allocates in its constructor only. One thread.
class PriorHistory {
 public:
  /// `capacity`: number of priors kept, at least 2; 4096 holds 5 s at 800 Hz and 20 s at 200 Hz (1.3 MB).
  /// `max_extrapolation_ns`: how far past the newest prior at() may go; 0.1 s is a few IMU samples of delay.
  explicit PriorHistory(std::size_t capacity = 4096, std::int64_t max_extrapolation_ns = 100'000'000);

  /// Takes a prior. One that is not newer than the newest is ignored: the history stays sorted.
  void add(const Prior& prior);

  /// Forgets everything, keeps the memory.
  void clear();

  /// True where at() would succeed.
  [[nodiscard]] bool covers(std::int64_t stamp_ns) const;

  /// False where the priors next to `stamp_ns` are so far apart, or so long ago, that the motion between them
  /// is not known: the IMU was silent.
  [[nodiscard]] bool dense_at(std::int64_t stamp_ns) const;

  /// State at `stamp_ns`, interpolated, or extrapolated at the newest end. False, and `out` untouched, before
  /// the oldest or too far after the newest. O(log n), no allocation.
  bool at(std::int64_t stamp_ns, Prior& out) const;

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// Only where !empty().
  [[nodiscard]] const Prior& oldest() const { return nth(0); }
  [[nodiscard]] const Prior& newest() const { return nth(count_ - 1); }

 private:
  [[nodiscard]] double height_rate_m_s() const;
  [[nodiscard]] std::size_t first_after(std::int64_t stamp_ns) const;
  [[nodiscard]] const Prior& nth(std::size_t age_order) const {
    const std::size_t index = first_ + age_order;
    return ring_[index < ring_.size() ? index : index - ring_.size()];
  }

  std::vector<Prior> ring_;
  std::size_t first_ = 0;  // index of the oldest
  std::size_t count_ = 0;
  std::int64_t max_extrapolation_ns_;
};

}  // namespace isobar
