// SPDX-License-Identifier: BSD-3-Clause
// Scans that follow each other closely say nearly the same: each serves for a part of the work, in turns.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace isobar {

/// How many scans share what one would do alone, so that every part has had its turn about every
/// `interval_s`: 1 … 4. `elapsed_s`: since the scan before; 1 where it is not positive.
[[nodiscard]] inline std::size_t parts_at(double elapsed_s, double interval_s) {
  constexpr double kMost = 4.0;
  return elapsed_s > 0.0
             ? static_cast<std::size_t>(std::lround(std::clamp(interval_s / elapsed_s, 1.0, kMost)))
             : 1;
}

}  // namespace isobar
