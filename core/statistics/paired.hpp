// SPDX-License-Identifier: BSD-3-Clause
// Mean difference of pairs, and whether it is more than their scatter.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace isobar {

/// Differences of pairs, such as an error of two configurations on each of n recordings.
struct PairedDifference {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::size_t count = 0;
  double mean = kNone;
  /// Half of the 95 % confidence interval of the mean: Student's t times the standard error; NaN for fewer than two pairs.
  double margin = kNone;

  /// True if the interval does not hold 0. False for fewer than two pairs: one pair says nothing of scatter.
  [[nodiscard]] bool is_clear() const;
};

/// Statistics of `second - first`; pairs with a value that is not finite are left out. Equal lengths.
/// Student's paired t-test (Student 1908, "The probable error of a mean").
PairedDifference paired_difference(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace isobar
