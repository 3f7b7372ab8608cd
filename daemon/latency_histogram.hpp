// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Histogram of durations with logarithmic buckets, four to an octave (a resolution of 19 %), from 10 us to
/// 0.6 s. Trivially copyable; the difference of two readings is the histogram of the time between them.
class LatencyHistogram {
 public:
  static constexpr std::size_t kBuckets = 64;

  void note(std::int64_t took_ns) noexcept { ++counts_[bucket_of(took_ns)]; }

  /// Takes all durations that another one counts.
  void add(const LatencyHistogram& other) noexcept {
    for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
  }

  /// Quantile of the durations counted here and not yet in `before` [ms]; NaN without any.
  /// @param share 0 … 1: 0.5 is the median
  [[nodiscard]] double quantile_ms(double share, const LatencyHistogram& before) const noexcept {
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) total += since(before, i);
    if (total == 0) return std::nan("");
    const double wanted = share * static_cast<double>(total);
    double seen = 0.0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      seen += static_cast<double>(since(before, i));
      if (seen >= wanted) return middle_ms(i);
    }
    return middle_ms(kBuckets - 1);
  }

 private:
  static constexpr double kFirstNs = 10'000.0;
  static constexpr double kPerOctave = 4.0;

  [[nodiscard]] std::uint32_t since(const LatencyHistogram& before, std::size_t bucket) const noexcept {
    return counts_[bucket] - before.counts_[bucket];
  }
  static std::size_t bucket_of(std::int64_t took_ns) noexcept {
    const auto ns = static_cast<double>(took_ns);
    if (!(ns > kFirstNs)) return 0;
    const auto bucket = static_cast<std::size_t>(kPerOctave * std::log2(ns / kFirstNs)) + 1;
    return bucket < kBuckets ? bucket : kBuckets - 1;
  }
  /// Geometric middle of a bucket.
  static double middle_ms(std::size_t bucket) noexcept {
    return kFirstNs * 1e-6 * std::exp2((static_cast<double>(bucket) - 0.5) / kPerOctave);
  }

  std::array<std::uint32_t, kBuckets> counts_{};  // wrap after years; differences stay right
};

}  // namespace isobar
