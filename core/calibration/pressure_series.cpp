// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/pressure_series.hpp"

#include <algorithm>
#include <limits>

#include "core/statistics/distribution.hpp"

namespace isobar {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Shortest gap, in median intervals: a few lost samples hide no weather.
constexpr double kGapIntervals = 5.0;

}  // namespace

PressureSeries::PressureSeries(const std::vector<std::int64_t>& stamps_ns, std::vector<double> pressures_pa,
                               double max_gap_s)
    : pressures_pa_(std::move(pressures_pa)) {
  std::vector<double> intervals;
  for (const std::int64_t stamp_ns : stamps_ns) {
    times_s_.push_back(time_s(stamp_ns));
    if (times_s_.size() > 1) intervals.push_back(times_s_.back() - times_s_[times_s_.size() - 2]);
  }
  if (!intervals.empty()) interval_s_ = median(intervals);
  const double longest_s = max_gap_s > 0.0 ? max_gap_s : kGapIntervals * interval_s_;
  integral_pa_s_.assign(times_s_.size(), 0.0);
  gaps_before_.assign(times_s_.size(), 0);
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const double mean_pa = 0.5 * (pressures_pa_[k] + pressures_pa_[k + 1]) - pressures_pa_.front();
    integral_pa_s_[k + 1] = integral_pa_s_[k] + intervals[k] * mean_pa;
    gaps_before_[k + 1] = gaps_before_[k] + (intervals[k] > longest_s ? 1 : 0);
  }
}

std::size_t PressureSeries::segment(double time_s) const {
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, time_s);
  return static_cast<std::size_t>(after - times_s_.begin()) - 1;
}

double PressureSeries::value_at(std::size_t segment, double time_s) const {
  const double share = (time_s - times_s_[segment]) / (times_s_[segment + 1] - times_s_[segment]);
  return pressures_pa_[segment] + share * (pressures_pa_[segment + 1] - pressures_pa_[segment]);
}

double PressureSeries::integral_to(std::size_t segment, double time_s) const {
  const double mean_pa = 0.5 * (pressures_pa_[segment] + value_at(segment, time_s)) - pressures_pa_.front();
  return integral_pa_s_[segment] + (time_s - times_s_[segment]) * mean_pa;
}

double PressureSeries::mean_pa(double time_s, double width_s) const {
  const double from_s = time_s - 0.5 * width_s;
  const double to_s = time_s + 0.5 * width_s;
  if (size() < 2 || !(from_s >= begin_s() && to_s <= end_s())) return kNone;
  const std::size_t first = segment(from_s);
  const std::size_t last = segment(to_s);
  if (gaps_before_[last + 1] != gaps_before_[first]) return kNone;
  if (to_s == from_s) return value_at(first, time_s);
  return pressures_pa_.front() + (integral_to(last, to_s) - integral_to(first, from_s)) / (to_s - from_s);
}

}  // namespace isobar
