// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/motion_series.hpp"

#include <algorithm>

#include "core/stamp.hpp"

namespace isobar {

namespace {

constexpr double kCellS = static_cast<double>(MotionSeries::kCellNs) * 1e-9;
// Share of a cell that must be covered: the first and the last cell of a stream are cut.
constexpr double kCoveredS = 0.95 * kCellS;

std::int64_t cell_of(std::int64_t stamp_ns) {
  const std::int64_t cell = stamp_ns / MotionSeries::kCellNs;
  return stamp_ns < cell * MotionSeries::kCellNs ? cell - 1 : cell;
}

}  // namespace

void MotionSeries::add_step(std::int64_t from_ns, std::int64_t to_ns, const PlanarStep& step,
                            bool way_known) {
  if (!plausible_stamp(from_ns) || !plausible_stamp(to_ns)) return;
  if (to_ns <= from_ns || to_ns - from_ns > kLongestGapNs) return;
  if (cells_.empty()) first_ = cell_of(from_ns);
  const double per_ns = 1.0 / static_cast<double>(to_ns - from_ns);
  for (std::int64_t cell = cell_of(from_ns); cell * kCellNs < to_ns; ++cell) {
    const std::int64_t index = cell - first_;
    if (index < 0 || index >= static_cast<std::int64_t>(kCapacity)) continue;
    if (index >= static_cast<std::int64_t>(cells_.size())) cells_.resize(static_cast<std::size_t>(index) + 1);
    const std::int64_t begin_ns = std::max(from_ns, cell * kCellNs);
    const std::int64_t end_ns = std::min(to_ns, (cell + 1) * kCellNs);
    const double share = static_cast<double>(end_ns - begin_ns) * per_ns;
    const auto time_s = static_cast<float>(seconds_between(begin_ns, end_ns));
    Cell& into = cells_[static_cast<std::size_t>(index)];
    into.turn_rad += static_cast<float>(share * step.turn_rad);
    into.turn_s += time_s;
    if (!way_known) continue;
    into.x_m += static_cast<float>(share * step.x_m);
    into.y_m += static_cast<float>(share * step.y_m);
    into.way_s += time_s;
  }
}

void MotionSeries::add_rate(std::int64_t stamp_ns, const PlanarStep& rate_per_s) {
  if (has_rate_ && plausible_stamp(stamp_ns)) {
    const double half_s = 0.5 * seconds_between(last_ns_, stamp_ns);
    add_step(last_ns_, stamp_ns,
             {half_s * (last_rate_.turn_rad + rate_per_s.turn_rad),
              half_s * (last_rate_.x_m + rate_per_s.x_m), half_s * (last_rate_.y_m + rate_per_s.y_m)},
             true);
  }
  has_rate_ = plausible_stamp(stamp_ns);
  last_ns_ = stamp_ns;
  last_rate_ = rate_per_s;
}

bool MotionSeries::turn_known(std::int64_t cell) const {
  return cell >= first_ && cell < end() && at(cell).turn_s >= kCoveredS;
}

PlanarSum MotionSeries::sum(std::int64_t cell, int count) const {
  PlanarSum sum;
  if (cell < first_ || cell + count > end()) return sum;
  sum.turn_known = sum.way_known = true;
  for (int i = 0; i < count; ++i) {
    const Cell& from = at(cell + i);
    sum.step.turn_rad += from.turn_rad;
    sum.step.x_m += from.x_m;
    sum.step.y_m += from.y_m;
    sum.turn_known = sum.turn_known && from.turn_s >= kCoveredS;
    sum.way_known = sum.way_known && from.way_s >= kCoveredS;
  }
  return sum;
}

}  // namespace isobar
