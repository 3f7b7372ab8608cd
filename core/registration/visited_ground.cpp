// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/visited_ground.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

VisitedGround::Cell VisitedGround::cell_of(const Eigen::Vector3d& p_map) {
  constexpr double kFarthest = 1e8;  // a cell's index must fit into 32 bits
  const Eigen::Vector3d edges(kCellM, kCellM, kStoreyM);
  // Storeys are centred on the height of the start, on whose floor the robot drives.
  const Eigen::Vector3d shifted = p_map + Eigen::Vector3d(0.0, 0.0, 0.5 * kStoreyM);
  return shifted.cwiseQuotient(edges).cwiseMax(-kFarthest).cwiseMin(kFarthest).array().floor().cast<int>();
}

void VisitedGround::add(const Cell& cell, const MapError& error) {
  Visit& visit = cells_[count_++ % kCells];
  visit.cell = cell;
  visit.random = error.pose.random.cast<float>();
  visit.constants = error.pose.constants.cast<float>();
  visit.height_variance_m2 = static_cast<float>(error.height_variance_m2);
}

std::optional<MapError> VisitedGround::find(const Cell& cell) const {
  const auto end = cells_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kCells));
  const auto visit = std::find_if(cells_.begin(), end, [&](const Visit& one) { return one.cell == cell; });
  if (visit == end) return std::nullopt;
  MapError error;
  error.pose.random = visit->random.cast<double>();
  error.pose.constants = visit->constants.cast<double>();
  error.height_variance_m2 = static_cast<double>(visit->height_variance_m2);
  return error;
}

}  // namespace isobar
