// SPDX-License-Identifier: BSD-3-Clause
// Verdict on an estimate: complete and near the reference, incomplete, or lost, with the reason.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "run/evaluation/association.hpp"

namespace isobar::evaluation {

/// Ascending badness.
enum class VerdictKind : std::uint8_t {
  kOk,
  kIncomplete,  ///< near the reference where it is known, which is not the whole time: stopped early, began late, gaps
  kLost,  ///< so far from the reference that scans no longer match the map
};

struct Verdict {
  VerdictKind kind = VerdictKind::kOk;
  std::string reason{};  ///< a clause, without a full stop; empty for kOk

  [[nodiscard]] bool ok() const { return kind == VerdictKind::kOk; }
};

/// "ok", "incomplete" or "LOST".
const char* verdict_word(VerdictKind kind);

/// Limits of a verdict.
struct VerdictLimits {
  double least_coverage = 0.95;  ///< 0 … 1
  /// The position error that ends a run exceeds both: below them a drift is a poor estimate, beyond them scans no
  /// longer match the map.
  double beyond_m = 5.0;
  double beyond_share_of_distance = 0.05;
};

/// @param pairs aligned, not empty
/// @param covered share of the reference's time that the estimate covers, 0 … 1
/// @param travelled_m by the reference
Verdict verdict_on(const std::vector<PosePair>& pairs, const Trajectory& reference, double covered,
                   double travelled_m, const VerdictLimits& limits);

}  // namespace isobar::evaluation
