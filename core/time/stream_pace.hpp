// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>

namespace isobar {

/// Regularity of a stream: mean sample interval, and jitter as the mean deviation from it, both running means
/// over about 16 samples (as RFC 3550, section 6.4.1, averages). Trivially copyable.
class StreamPace {
 public:
  /// A sample with this stamp arrived; a stamp that does not ascend is ignored.
  void add(std::int64_t stamp_ns) noexcept {
    const std::int64_t interval_ns = stamp_ns - last_ns_;
    if (samples_ > 0 && interval_ns <= 0) return;
    if (samples_ == 1) mean_ns_ = interval_ns;
    if (samples_ > 1) {
      jitter_ns_ += (std::abs(interval_ns - mean_ns_) - jitter_ns_) / kMemorySamples;
      mean_ns_ += (interval_ns - mean_ns_) / kMemorySamples;
    }
    last_ns_ = stamp_ns;
    ++samples_;
  }

  /// At least two intervals are known.
  [[nodiscard]] bool known() const noexcept { return samples_ > 2; }
  [[nodiscard]] std::int64_t interval_ns() const noexcept { return mean_ns_; }
  [[nodiscard]] std::int64_t jitter_ns() const noexcept { return jitter_ns_; }

 private:
  static constexpr std::int64_t kMemorySamples = 16;

  std::uint64_t samples_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t mean_ns_ = 0;
  std::int64_t jitter_ns_ = 0;
};

}  // namespace isobar
