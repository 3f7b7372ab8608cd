// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace isobar {

/// What a box plot shows of a set of numbers; all NaN if the set is empty.
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

/// Quantile 0 … 1 of ascending numbers, linear between order statistics (Hyndman & Fan 1996, type 7);
/// NaN if there are none.
double quantile(const std::vector<double>& ascending, double q);

/// Quantile 0.5 of numbers in any order.
double median(std::vector<double> values);

Distribution summarize(std::vector<double> values);

}  // namespace isobar
