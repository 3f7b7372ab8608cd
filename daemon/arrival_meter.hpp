// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include "core/samples.hpp"
#include "core/time/cadence.hpp"
#include "daemon/latency_histogram.hpp"

namespace isobar {

/// How the samples of a stream arrive. NaN: unknown.
struct ArrivalFigures {
  double offset_s = std::nan("");        ///< sensor's clock minus robot clock; unknown: it has none
  double latency_ms = std::nan("");      ///< from stamp to arrival, median
  double latency_p99_ms = std::nan("");  ///< likewise
  double jitter_ms = std::nan("");       ///< standard deviation of the interval between arrivals

  bool measured = false;  ///< there was an arrival at any time

  [[nodiscard]] bool known() const noexcept { return !std::isnan(latency_ms); }
};

/// Measures a stream's arrivals over the last 10 to 20 s: two spans of 10 s, of which the older one is complete.
/// Samples that arrive together are one arrival; a pause that is silence (Cadence) is no interval. Begins anew where
/// the offset of the sensor's clock jumps: stamps before and after do not compare. Trivially copyable, no
/// allocation, one thread.
///
/// Stamps of a sensor with a clock come from its earliest arrivals (ClockAnchor), so that its latency is that above
/// the shortest.
class ArrivalMeter {
 public:
  static constexpr std::int64_t kSpanNs = 10'000'000'000;
  /// Smallest jump of the offset: that at which ClockAnchor begins anew.
  static constexpr std::int64_t kJumpNs = 50'000'000;

  /// @param stamp_ns time of the measurement, robot clock
  void add(std::int64_t stamp_ns, const SampleTiming& timing) noexcept {
    if (timing.received_ns == 0) return;
    if (jumped(timing.clock_ahead_ns)) *this = ArrivalMeter{};
    clock_ahead_ns_ = timing.clock_ahead_ns;
    turn_over(timing.received_ns);
    newest_.latency.note(timing.received_ns - stamp_ns);
    ++newest_.samples;
    const std::int64_t interval_ns = timing.received_ns - cadence_.last_ns();
    if (cadence_.started() && interval_ns <= 0) return;
    if (cadence_.started() && !cadence_.silent(timing.received_ns)) newest_.add_interval(interval_ns);
    cadence_.add(timing.received_ns);
  }

  /// Unknown while the stream is silent.
  /// @param now_ns robot clock
  [[nodiscard]] ArrivalFigures figures(std::int64_t now_ns) const noexcept {
    ArrivalFigures figures;
    figures.measured = cadence_.started();
    if (!cadence_.started() || cadence_.silent(now_ns)) return figures;
    LatencyHistogram latency = newest_.latency;
    latency.add(older_.latency);
    figures.latency_ms = latency.quantile_ms(0.5, {});
    figures.latency_p99_ms = latency.quantile_ms(0.99, {});
    figures.jitter_ms = jitter_ms();
    if (clock_ahead_ns_ != SampleTiming::kNoClock)
      figures.offset_s = static_cast<double>(clock_ahead_ns_) * 1e-9;
    return figures;
  }

 private:
  struct Span {
    std::int64_t begin_ns = 0;
    std::uint64_t samples = 0;
    LatencyHistogram latency;
    // Mean and sum of squared deviations of the intervals (Welford 1962) [ms, ms^2].
    double intervals = 0.0;
    double mean_ms = 0.0;
    double squares_ms2 = 0.0;

    void add_interval(std::int64_t interval_ns) noexcept {
      const double interval_ms = static_cast<double>(interval_ns) * 1e-6;
      const double before_ms = interval_ms - mean_ms;
      intervals += 1.0;
      mean_ms += before_ms / intervals;
      squares_ms2 += before_ms * (interval_ms - mean_ms);
    }
  };

  [[nodiscard]] bool jumped(std::int64_t clock_ahead_ns) const noexcept {
    if (!cadence_.started() || clock_ahead_ns == clock_ahead_ns_) return false;
    if (clock_ahead_ns == SampleTiming::kNoClock || clock_ahead_ns_ == SampleTiming::kNoClock) return true;
    return clock_ahead_ns > clock_ahead_ns_ + kJumpNs || clock_ahead_ns < clock_ahead_ns_ - kJumpNs;
  }
  void turn_over(std::int64_t now_ns) noexcept {
    if (newest_.samples > 0 && now_ns - newest_.begin_ns < kSpanNs) return;
    const bool follows = newest_.samples > 0 && now_ns - newest_.begin_ns < 2 * kSpanNs;
    older_ = follows ? newest_ : Span{};
    newest_ = Span{};
    newest_.begin_ns = now_ns;
  }
  /// Of both spans together (Chan, Golub, LeVeque 1983).
  [[nodiscard]] double jitter_ms() const noexcept {
    const double count = newest_.intervals + older_.intervals;
    if (count < 2.0) return std::nan("");
    const double apart_ms = newest_.mean_ms - older_.mean_ms;
    const double squares_ms2 = newest_.squares_ms2 + older_.squares_ms2 +
                               apart_ms * apart_ms * newest_.intervals * older_.intervals / count;
    return std::sqrt(squares_ms2 / (count - 1.0));
  }

  Span older_;
  Span newest_;
  Cadence cadence_;  ///< of the arrivals
  std::int64_t clock_ahead_ns_ = SampleTiming::kNoClock;
};

}  // namespace isobar
