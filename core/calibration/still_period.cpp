// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/still_period.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/statistics/distribution.hpp"

namespace isobar {
namespace {

// Median of |x| of a normal variable, in standard deviations.
constexpr double kMedianOfAbsNormal = 0.6744897501960817;
// Threshold of motion in standard deviations: one false alarm in 16 000 comparisons.
constexpr double kSigmas = 4.0;

/// Mean over the samples of one window.
struct Block {
  std::size_t begin = 0;
  std::size_t end = 0;
  double mean_pa = 0.0;
  [[nodiscard]] double count() const { return static_cast<double>(end - begin); }
};

std::vector<Block> blocks_of(std::span<const double> times_s, std::span<const double> pressures_pa,
                             double window_s) {
  std::vector<Block> blocks;
  const std::size_t count = std::min(times_s.size(), pressures_pa.size());
  for (std::size_t begin = 0; begin < count;) {
    Block block{begin, begin, pressures_pa[begin]};
    double sum_pa = 0.0;
    while (block.end < count && times_s[block.end] < times_s[begin] + window_s) {
      sum_pa += pressures_pa[block.end++] - block.mean_pa;
    }
    block.mean_pa += sum_pa / block.count();
    blocks.push_back(block);
    begin = block.end;
  }
  return blocks;
}

}  // namespace

double robust_sigma(std::span<const double> values) {
  if (values.size() < 3) return 0.0;
  std::vector<double> differences;
  differences.reserve(values.size() - 2);
  for (std::size_t i = 2; i < values.size(); ++i) {
    differences.push_back(std::abs(values[i] - 2.0 * values[i - 1] + values[i - 2]));
  }
  return upper_median(differences) / (kMedianOfAbsNormal * std::sqrt(6.0));
}

StillPeriod longest_still_period(std::span<const double> times_s, std::span<const double> pressures_pa,
                                 double sigma_pa, double max_rate_pa_s, double window_s) {
  const std::vector<Block> blocks = blocks_of(times_s, pressures_pa, window_s);
  StillPeriod longest;
  std::size_t first = 0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const Block& before = blocks[i - 1];
    const Block& now = blocks[i];
    const double noise_pa = sigma_pa * std::sqrt(1.0 / before.count() + 1.0 / now.count());
    const bool moved = std::abs(now.mean_pa - before.mean_pa) > max_rate_pa_s * window_s + kSigmas * noise_pa;
    const bool gap = times_s[now.begin] - times_s[before.end - 1] > window_s;
    if (moved || gap) first = i;
    if (i > first && now.end - blocks[first].begin > longest.count()) {
      longest = {blocks[first].begin, now.end};
    }
  }
  return longest;
}

}  // namespace isobar
