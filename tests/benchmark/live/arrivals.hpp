// SPDX-License-Identifier: BSD-3-Clause
// Latencies between departures and arrivals.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

namespace isobar::benchmark {

/// A stamped message seen at `at_ns`, steady clock.
struct Event {
  std::int64_t stamp_ns = 0;
  std::int64_t at_ns = 0;
};

/// Median, tail and maximum of latencies.
struct Summary {
  std::size_t count = 0;
  double median_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

inline Summary summary_of(std::vector<std::int64_t> latencies_ns) {
  Summary result;
  result.count = latencies_ns.size();
  if (latencies_ns.empty()) return result;
  std::sort(latencies_ns.begin(), latencies_ns.end());
  // Nearest-rank quantile.
  const auto at = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(latencies_ns.size())));
    return static_cast<double>(latencies_ns[std::max<std::size_t>(rank, 1) - 1]) * 1e-6;
  };
  result.median_ms = at(0.5);
  result.p99_ms = at(0.99);
  result.max_ms = at(1.0);
  return result;
}

/// Latencies of arrivals matched with departures of the same stamp within `tolerance_ns` (clocks are anchored
/// separately). Both ascend in stamps. `lost`: number of departures without an arrival.
struct Matched {
  std::vector<std::int64_t> latencies_ns;
  std::size_t lost = 0;
};

inline Matched match(const std::vector<Event>& departures, const std::vector<Event>& arrivals,
                     std::int64_t tolerance_ns) {
  Matched matched;
  auto arrival = arrivals.begin();
  for (const Event& departure : departures) {
    while (arrival != arrivals.end() && arrival->stamp_ns < departure.stamp_ns - tolerance_ns) ++arrival;
    if (arrival == arrivals.end() || arrival->stamp_ns > departure.stamp_ns + tolerance_ns) {
      ++matched.lost;
    } else {
      matched.latencies_ns.push_back(arrival->at_ns - departure.at_ns);
    }
  }
  return matched;
}

}  // namespace isobar::benchmark
