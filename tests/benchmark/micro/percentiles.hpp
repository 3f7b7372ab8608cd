// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/statistics/distribution.hpp"

namespace isobar::bench {

/// Sets median, p99 and maximum of `values` as counters of a benchmark.
inline void count_percentiles(benchmark::State& state, std::vector<double> values, const std::string& unit) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  state.counters["median_" + unit] = quantile(values, 0.5);
  state.counters["p99_" + unit] = quantile(values, 0.99);
  state.counters["max_" + unit] = values.back();
}

}  // namespace isobar::bench
