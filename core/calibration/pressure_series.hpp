// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace isobar {

/// A logged pressure as a function of time: linear between samples, none across gaps. For work after the
/// fact.
class PressureSeries {
 public:
  /// Stamps must ascend. Samples further apart than `max_gap_s`, or if that is 0 than five times the median
  /// interval, have a gap between them.
  PressureSeries(const std::vector<std::int64_t>& stamps_ns, std::vector<double> pressures_pa,
                 double max_gap_s = 0.0);

  /// Mean over `width_s` about a moment, in a closed form; width 0 is the value there. NaN where the span
  /// reaches beyond the samples or touches a gap.
  [[nodiscard]] double mean_pa(double time_s, double width_s) const;

  /// Time of a stamp as mean_pa() counts it: since 1970, or whatever the stamps count from [s].
  [[nodiscard]] static double time_s(std::int64_t stamp_ns) { return 1e-9 * static_cast<double>(stamp_ns); }

  [[nodiscard]] std::size_t size() const { return times_s_.size(); }
  [[nodiscard]] double begin_s() const { return times_s_.front(); }
  [[nodiscard]] double end_s() const { return times_s_.back(); }
  /// Median time between samples; 0 with fewer than two.
  [[nodiscard]] double interval_s() const { return interval_s_; }

 private:
  /// Samples [index, index + 1] around a moment.
  [[nodiscard]] std::size_t segment(double time_s) const;
  [[nodiscard]] double value_at(std::size_t segment, double time_s) const;
  /// Integral of pressure less the first from the first sample to a moment in that segment.
  [[nodiscard]] double integral_to(std::size_t segment, double time_s) const;

  std::vector<double> times_s_;
  std::vector<double> pressures_pa_;
  std::vector<double> integral_pa_s_;
  std::vector<std::size_t> gaps_before_;  // segments of [0, k) that are gaps
  double interval_s_ = 0.0;
};

}  // namespace isobar
