// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace isobar {

/// How often the samples of a stream come, learnt from the stream itself, and when they no longer do.
///
/// The interval is a running mean over some ten samples. A longer pause counts as no more than the silence
/// that it is, so that one outage does not pass for a slow stream, and a stream that has become slower is
/// learnt within some ten samples.
class Cadence {
 public:
  /// Silence is told after so many intervals: two samples lost in a row are ordinary on a radio link …
  static constexpr std::int64_t kIntervalsToSilence = 4;
  /// … but not before this [ns], whatever the rate, and no later than that.
  static constexpr std::int64_t kShortestLimitNs = 500'000'000;
  static constexpr std::int64_t kLongestLimitNs = 30'000'000'000;
  /// The limit until an interval is known [ns]: the slowest base stations send every few seconds.
  static constexpr std::int64_t kFirstLimitNs = 10'000'000'000;

  /// A sample came at `time_ns`, not before the one before.
  void add(std::int64_t time_ns) noexcept {
    if (samples_ > 0) learn(std::max<std::int64_t>(0, time_ns - last_ns_));
    last_ns_ = time_ns;
    ++samples_;
  }
  /// Forgets everything: another sender.
  void restart() noexcept { *this = Cadence{}; }

  [[nodiscard]] bool started() const noexcept { return samples_ > 0; }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_; }
  /// 0: not known yet.
  [[nodiscard]] std::int64_t interval_ns() const noexcept { return samples_ > 1 ? interval_ns_ : 0; }
  /// A pause longer than this is silence [ns].
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
