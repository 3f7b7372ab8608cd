// SPDX-License-Identifier: BSD-3-Clause
// Learnt sample interval of a stream.
#pragma once

#include <algorithm>
#include <cstdint>

namespace isobar {

/// Sample interval of a stream, learnt from the stream itself, and detection of its silence.
///
/// The interval is a running mean over about ten samples. Pauses are clipped at the limit of silence, so one
/// outage does not look like a slow stream, while a slower rate is still learnt within about ten samples.
class Cadence {
 public:
  /// Intervals without a sample after which a stream is silent: on a radio link two samples in a row may be
  /// lost.
  static constexpr std::int64_t kIntervalsToSilence = 4;
  /// Bounds of the limit at any rate.
  static constexpr std::int64_t kShortestLimitNs = 500'000'000;
  static constexpr std::int64_t kLongestLimitNs = 30'000'000'000;
  /// Limit until an interval is known: the slowest base stations send every few seconds.
  static constexpr std::int64_t kFirstLimitNs = 10'000'000'000;

  /// A sample arrived at `time_ns`; times must not descend.
  void add(std::int64_t time_ns) noexcept {
    if (samples_ > 0) learn(std::max<std::int64_t>(0, time_ns - last_ns_));
    last_ns_ = time_ns;
    ++samples_;
  }
  /// Forgets everything, for another sender.
  void restart() noexcept { *this = Cadence{}; }

  [[nodiscard]] bool started() const noexcept { return samples_ > 0; }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_; }
  /// 0: unknown.
  [[nodiscard]] std::int64_t interval_ns() const noexcept { return samples_ > 1 ? interval_ns_ : 0; }
  /// Longest pause that is not silence [ns].
  [[nodiscard]] std::int64_t limit_ns() const noexcept {
    return samples_ > 1 ? std::clamp(kIntervalsToSilence * interval_ns_, kShortestLimitNs, kLongestLimitNs)
                        : kFirstLimitNs;
  }
  [[nodiscard]] bool silent(std::int64_t now_ns) const noexcept {
    return started() && now_ns - last_ns_ > limit_ns();
  }

 private:
  static constexpr std::int64_t kMemorySamples = 8;

  void learn(std::int64_t pause_ns) noexcept {
    if (samples_ == 1) {
      interval_ns_ = std::min(pause_ns, kLongestLimitNs);
      return;
    }
    const std::int64_t known = std::min<std::int64_t>(static_cast<std::int64_t>(samples_), kMemorySamples);
    interval_ns_ += (std::min(pause_ns, limit_ns()) - interval_ns_) / known;
  }

  std::uint64_t samples_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t interval_ns_ = 0;
};

}  // namespace isobar
