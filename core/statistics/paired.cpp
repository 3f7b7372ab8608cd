// SPDX-License-Identifier: BSD-3-Clause
#include "core/statistics/paired.hpp"

#include <array>
#include <cmath>

namespace isobar {

namespace {

/// 97.5 % quantiles of Student's t with 1 … 30 degrees of freedom, from its tables; beyond, the normal distribution's is
/// 4 % off at most.
constexpr std::array<double, 30> kQuantiles{
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
    2.120,  2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
constexpr double kNormalQuantile = 1.960;

double t_quantile(std::size_t freedom) {
  return freedom <= kQuantiles.size() ? kQuantiles[freedom - 1] : kNormalQuantile;
}

}  // namespace

bool PairedDifference::is_clear() const { return std::isfinite(margin) && std::abs(mean) > margin; }

PairedDifference paired_difference(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (std::isfinite(first[i]) && std::isfinite(second[i])) differences.push_back(second[i] - first[i]);
  }
  PairedDifference result;
  result.count = differences.size();
  if (differences.empty()) return result;
  const auto count = static_cast<double>(differences.size());
  result.mean = 0.0;
  for (const double one : differences) result.mean += one / count;
  if (differences.size() < 2) return result;
  double sum = 0.0;
  for (const double one : differences) sum += (one - result.mean) * (one - result.mean);
  const double standard_error = std::sqrt(sum / (count - 1.0) / count);
  result.margin = t_quantile(differences.size() - 1) * standard_error;
  return result;
}

}  // namespace isobar
