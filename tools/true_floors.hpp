// SPDX-License-Identifier: BSD-3-Clause
// The floors of a simulated building, from its reference.
#pragma once

#include <optional>
#include <vector>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::tools {

/// Floors are the heights of the segments "flat". They are counted as a run counts them: from the one where it begins.
class TrueFloors {
 public:
  explicit TrueFloors(const evaluation::ReferenceData& reference);

  /// Heights, ascending [m].
  [[nodiscard]] const std::vector<double>& levels_m() const { return levels_m_; }
  /// Between the two lowest floors; 3 m for a single one.
  [[nodiscard]] double storey_m() const { return levels_m_.size() > 1 ? levels_m_[1] - levels_m_[0] : 3.0; }
  /// Number of the floor of a pose of the reference; none off the floors.
  [[nodiscard]] std::optional<int> number_at(const evaluation::StampedPose& pose) const;

 private:
  [[nodiscard]] bool is_flat(std::int64_t stamp_ns) const;
  [[nodiscard]] std::optional<int> level_of(const evaluation::StampedPose& pose) const;

  std::vector<evaluation::Segment> flat_;  ///< in order of time
  std::vector<double> levels_m_;
  int first_ = 0;  ///< index of the level where the run begins
};

}  // namespace isobar::tools
