// SPDX-License-Identifier: BSD-3-Clause
// Ring buffer of the priors of the last seconds, with interpolation; deskewing and registration query it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/estimates.hpp"

namespace isobar {

/// Ring buffer of fixed capacity, overwrites the oldest. Allocates in its constructor only. Not thread-safe.
class PriorHistory {
 public:
  /// `capacity`: number of priors kept, at least 2; 4096 holds 5 s at 800 Hz and 20 s at 200 Hz (1.3 MB).
  /// `max_extrapolation_ns`: how far past the newest prior at() extrapolates; 0.1 s covers the IMU's delay.
  explicit PriorHistory(std::size_t capacity = 4096, std::int64_t max_extrapolation_ns = 100'000'000);

  /// Appends a prior. Ignores one that is not newer than the newest: the history stays sorted.
  void add(const Prior& prior);
  void clear() { count_ = 0; }

  /// False where the priors around `stamp_ns` are more than 0.5 s apart, or at() would fail: the IMU was
  /// silent and the motion is unknown.
  [[nodiscard]] bool dense_at(std::int64_t stamp_ns) const;

  /// Prior at `stamp_ns`. Between two priors: rotation by slerp; translation, height, twist and variances
  /// linearly; a flag is set only where both have it; the height source is the worse of the two. Beyond the
  /// newest: constant twist, and the height at its own mean rate, which differs from the twist's vertical
  /// speed where the ground moves (elevator). False, and `out` unchanged, before the oldest and more than
  /// `max_extrapolation_ns` after the newest. O(log n), no allocation.
  bool at(std::int64_t stamp_ns, Prior& out) const;

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t size() const { return count_; }
  /// Prior number `index` from the oldest. Precondition: index < size().
  [[nodiscard]] const Prior& operator[](std::size_t index) const { return nth(index); }
  /// Precondition of both: !empty().
  [[nodiscard]] const Prior& oldest() const { return nth(0); }
  [[nodiscard]] const Prior& newest() const { return nth(count_ - 1); }

 private:
  [[nodiscard]] bool covers(std::int64_t stamp_ns) const;
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
