// SPDX-License-Identifier: BSD-3-Clause
#include "core/statistics/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

double quantile(const std::vector<double>& ascending, double q) {
  if (ascending.empty()) return Distribution::kNone;
  const double rank = q * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (rank - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

Distribution summarize(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Distribution result;
  result.count = values.size();
  result.p05 = quantile(values, 0.05);
  result.q25 = quantile(values, 0.25);
  result.median = quantile(values, 0.50);
  result.q75 = quantile(values, 0.75);
  result.p95 = quantile(values, 0.95);
  result.p99 = quantile(values, 0.99);
  if (!values.empty()) result.max = values.back();
  return result;
}

}  // namespace isobar
