// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_fitter.hpp"

#include <cmath>
#include <utility>

#include "core/geometry.hpp"

namespace isobar {

namespace {

PlaneCriteria criteria_of(const MapConfig& config) {
  PlaneCriteria criteria;
  criteria.max_thickness_m = static_cast<float>(config.max_thickness_m);
  criteria.max_normal_deviation_rad = static_cast<float>(config.max_normal_deviation_deg * kRadPerDeg);
  return criteria;
}

// Seen from the same side.
bool same_way(const MapCell& a, const MapCell& b) {
  return a.toward[0] * b.toward[0] + a.toward[1] * b.toward[1] + a.toward[2] * b.toward[2] > 0;
}

}  // namespace

PlaneFitter::PlaneFitter(const MapConfig& config, FindTile find_tile)
    : cell_m_(static_cast<float>(config.cell_m)),
      criteria_(criteria_of(config)),
      find_tile_(std::move(find_tile)) {}

Moments PlaneFitter::neighbourhood(const MapTile& tile, const CellIndex& at, const MapCell& centre) const {
  // Same side only: a thin wall has two.
  const int side = centre.slot / kPlacesPerBlock;
  const CellIndex first = at.array() - 1;
  const CellIndex last = at.array() + 1;
  MomentSum sum;
  for_each_block(first, last, [&](const CellIndex& block_first, const CellIndex& low, const CellIndex& high) {
    const TileKey key = tile_of(block_first);
    const MapTile* in = key == tile.key() ? &tile : find_tile_(key);
    const MapBlock* block = in != nullptr ? in->block(block_of(block_first)) : nullptr;
    if (block == nullptr) return;
    for_each_in_window(block->mask(), side, low, high, [&](int slot) {
      const MapCell& other = *block->find(slot);
      if (same_way(other, centre)) {
        const CellIndex offset = block_first + offset_of(slot % kPlacesPerBlock) - at;
        sum.add(other.moments, offset);
      }
    });
  });
  return sum.in_metres(cell_m_);
}

Moments PlaneFitter::cube_around(const MapBlock& block, int slot) const {
  const CellIndex centre = offset_of(slot % kPlacesPerBlock);
  MomentSum sum;
  for_each_in_cube(block.mask(), slot % kPlacesPerBlock, [&](int member) {
    const CellIndex offset = offset_of(member % kPlacesPerBlock) - centre;
    sum.add(block.find(member)->moments, offset);
  });
  return sum.in_metres(cell_m_);
}

bool PlaneFitter::fit(const MapTile& tile, std::size_t block_index, int slot, PackedPlane& packed) const {
  const MapBlock& block = *tile.block(block_index);
  const MapCell& cell = *block.find(slot);
  const CellIndex offset = offset_of(slot % kPlacesPerBlock);
  PlaneCriteria own = criteria_;
  own.max_normal_deviation_rad *= kOwnCellShare;
  Plane plane;  // about the cell's centre
  if (!fit_plane(cell.moments.in_metres(cell_m_), own, plane) &&
      !fit_plane(neighbourhood(tile, first_cell(tile.key(), block_index) + offset, cell), criteria_, plane) &&
      !fit_plane(cube_around(block, slot), criteria_, plane)) {
    return false;
  }
  // The plane's point nearest to the cell's own mean.
  const Eigen::Vector3f mean = cell.moments.mean_m(cell_m_);
  const float off_plane = plane.normal.dot(mean - plane.mean);
  if (std::abs(off_plane) > 2.0F * criteria_.max_thickness_m) {
    return false;
  }
  const Eigen::Vector3f q_cell = mean - off_plane * plane.normal;
  const Eigen::Vector3f centre_block = (offset.cast<float>().array() + 0.5F * (1 - kBlockCells)) * cell_m_;
  const bool away = plane.normal.dot(cell.toward_vector()) < 0.0F;
  packed = PackedPlane::of(centre_block + q_cell, away ? (-plane.normal).eval() : plane.normal, cell_m_);
  return true;
}

}  // namespace isobar
