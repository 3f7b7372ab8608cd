// SPDX-License-Identifier: BSD-3-Clause
// Decimation of scans that follow each other closely: they are redundant, so each processes a share in turn.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace isobar {

/// Decimation factor n, 1 … 4: each scan processes every n-th item, and n scans in a row, about `interval_s`
/// long, process every item once. `elapsed_s`: time since the previous scan; n is 1 if it is not positive.
[[nodiscard]] inline std::size_t decimation_factor(double elapsed_s, double interval_s) {
  constexpr double kMaxFactor = 4.0;  // so that no item waits for more than four scans
  return elapsed_s > 0.0
             ? static_cast<std::size_t>(std::lround(std::clamp(interval_s / elapsed_s, 1.0, kMaxFactor)))
             : 1;
}

}  // namespace isobar
