// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/visited_ground.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

VisitedGround::Cell VisitedGround::cell_of(const Eigen::Vector3d& p_map) {
  constexpr double kFarthest = 1e8;  // a cell's index must fit into 32 bits
  const Eigen::Vector3d edges(kCellM, kCellM, kStoreyM);
  // Cells are centred on the start, to which robots return, and storeys on its floor.
  const Eigen::Vector3d shifted = p_map + 0.5 * edges;
  return shifted.cwiseQuotient(edges).cwiseMax(-kFarthest).cwiseMin(kFarthest).array().floor().cast<int>();
}

void VisitedGround::add(const Cell& cell, const MapError& error, double way_m) {
  Visit& visit = cells_[count_++ % kCells];
  visit.cell = cell;
  visit.random = error.pose.random.cast<float>();
  visit.constants = error.pose.constants.cast<float>();
  visit.height_variance_m2 = static_cast<float>(error.height_variance_m2);
  visit.way_m = way_m;
}

std::optional<MapError> VisitedGround::find(const Cell& cell, double way_m) const {
  const std::size_t known = std::min(count_, kCells);
  const Visit* visit = nullptr;
  for (std::size_t i = 0; i < known; ++i) {
    const Visit& one = cells_[i];
    const Cell away = (one.cell - cell).cwiseAbs();
    if (away.isZero()) {
      visit = &one;
      break;
    }
    const bool neighbour = away.z() == 0 && away.maxCoeff() == 1 && one.way_m < way_m;
    if (neighbour && (visit == nullptr || one.way_m < visit->way_m)) visit = &one;
  }
  if (visit == nullptr) return std::nullopt;
  MapError error;
  error.pose.random = visit->random.cast<double>();
  error.pose.constants = visit->constants.cast<double>();
  error.height_variance_m2 = static_cast<double>(visit->height_variance_m2);
  return error;
}

}  // namespace isobar
