// SPDX-License-Identifier: BSD-3-Clause
// Order statistics: quantiles, medians, box-plot summary.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace isobar {

/// Box-plot summary of a sample; all NaN if it is empty.
struct Distribution {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::size_t count = 0;
  double p05 = kNone;
  double q25 = kNone;
  double median = kNone;
  double q75 = kNone;
  double p95 = kNone;
  double p99 = kNone;
  double max = kNone;
};

/// Quantile `q`, 0 … 1, of ascending numbers, linear between order statistics (Hyndman & Fan 1996, type 7);
/// NaN if there are none.
double quantile(const std::vector<double>& ascending, double q);

/// Quantile 0.5 of numbers in any order; NaN if there are none.
double median(std::vector<double> values);

/// Upper median in linear time: order statistic n / 2 (0-based), always one of the values. Reorders them;
/// there must be at least one.
template <typename Value>
Value upper_median(std::vector<Value>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Distribution summarize(std::vector<double> values);

}  // namespace isobar
