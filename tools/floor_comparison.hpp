// SPDX-License-Identifier: BSD-3-Clause
// Floors that a run tells, and where its loops put it, against the truth.
#pragma once

#include <cstddef>
#include <filesystem>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::tools {

struct FloorComparison {
  std::size_t floors = 0;  ///< in truth: heights of the flat segments
  std::size_t told = 0;    ///< floors of the run's map
  std::size_t poses = 0;   ///< on a floor in truth
  std::size_t known = 0;   ///< of them, with a floor that is told
  std::size_t wrong = 0;   ///< of them, with another one than the true one
  /// Poses of the corrected trajectory that are half a storey or more from their true height: what a loop between two
  /// floors leaves. Such a loop moves whole submaps by a storey, or tears the chain between them.
  std::size_t torn = 0;
  double worst_corrected_m = 0.0;  ///< largest error in height of the corrected trajectory
};

/// Compares a run with its recording. Floors are counted from the one where the run began.
/// @throws DataError when a file is missing or breaks its format
[[nodiscard]] FloorComparison compare_floors(const evaluation::ReferenceData& reference,
                                             const std::filesystem::path& run);

/// The comparison in two lines.
void print_floor_comparison(const char* name, const FloorComparison& figures);

}  // namespace isobar::tools
