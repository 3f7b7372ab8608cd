// SPDX-License-Identifier: BSD-3-Clause
// Interpolated pressure log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace isobar {

/// A logged pressure as a function of time: linear between samples, undefined across gaps. For offline use.
class PressureSeries {
 public:
  /// Stamps must ascend. Samples further apart than `max_gap_s` have a gap between them; 0: five times the
  /// median interval.
  PressureSeries(const std::vector<std::int64_t>& stamps_ns, std::vector<double> pressures_pa,
                 double max_gap_s = 0.0);

  /// Mean over `width_s` centred at `time_s`, in closed form; width 0: the value there. NaN if the window
  /// reaches beyond the samples or into a gap.
  [[nodiscard]] double mean_pa(double time_s, double width_s) const;

  /// Time of a stamp for mean_pa() [s], from the same epoch as the stamps.
  [[nodiscard]] static double time_s(std::int64_t stamp_ns) { return 1e-9 * static_cast<double>(stamp_ns); }

  [[nodiscard]] std::size_t size() const { return times_s_.size(); }
  [[nodiscard]] double begin_s() const { return times_s_.front(); }
  [[nodiscard]] double end_s() const { return times_s_.back(); }
  /// Median time between samples; 0 with fewer than two.
  [[nodiscard]] double interval_s() const { return interval_s_; }

 private:
  /// Index of the sample that begins the segment around a time.
  [[nodiscard]] std::size_t segment(double time_s) const;
  [[nodiscard]] double value_at(std::size_t segment, double time_s) const;
  /// Integral of (pressure - first pressure) from the first sample to a time within that segment.
  [[nodiscard]] double integral_to(std::size_t segment, double time_s) const;

  std::vector<double> times_s_;
  std::vector<double> pressures_pa_;
  std::vector<double> integral_pa_s_;
  std::vector<std::size_t> gaps_before_;  // number of gaps among segments [0, k)
  double interval_s_ = 0.0;
};

}  // namespace isobar
