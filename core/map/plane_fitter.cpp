// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_fitter.hpp"

#include <algorithm>
#include <array>
#include <bitset>
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

// True if both cells were seen from the same side.
bool same_way(const MapCell& a, const MapCell& b) {
  return a.facing[0] * b.facing[0] + a.facing[1] * b.facing[1] + a.facing[2] * b.facing[2] > 0;
}

// Noise of a single point along the normal, standard deviation [m].
constexpr float kPointNoiseM = 0.01F;

// Reach of that noise from a surface: three standard deviations.
constexpr float kNoiseReachM = 3.0F * kPointNoiseM;

// Share of the distance between a cell's own mean and the plane of its neighbourhood that the cell keeps, 0 … 1: the
// posterior mean under the roughness of the surface (variance of the cells' means about the plane) and the noise of
// `count` points. A plane moved off its own points would pull each scan that sees them again.
float own_share(float count, float thickness_m) {
  const float noise2 = kPointNoiseM * kPointNoiseM;
  const float roughness2 = std::max(0.0F, thickness_m * thickness_m - noise2);
  return count * roughness2 / (count * roughness2 + noise2);
}

}  // namespace

PlaneFitter::PlaneFitter(const MapConfig& config, FindTile find_tile)
    : cell_m_(static_cast<float>(config.cell_m)),
      criteria_(criteria_of(config)),
      find_tile_(std::move(find_tile)) {}

class PlaneFitter::Surroundings {
 public:
  Surroundings(const MapTile& tile, std::size_t block_index, const FindTile& find_tile)
      : tile_(tile),
        find_tile_(find_tile),
        first_(first_cell(tile.key(), block_index)),
        centre_(*tile.block(block_index)) {}

  [[nodiscard]] const CellIndex& first() const { return first_; }
  [[nodiscard]] const MapBlock& centre() const { return centre_; }

  // The block whose first cell is `first`; null if nothing was seen there. It must be the centre block or one
  // of its 26 neighbours.
  const MapBlock* block_at(const CellIndex& first) {
    const CellIndex step = (first - first_) / kBlockCells;
    const int number = ((step.z() + 1) * 3 + step.y() + 1) * 3 + step.x() + 1;
    const auto at = static_cast<std::size_t>(number);
    if (!known_.test(at)) {
      const TileKey key = tile_of(first);
      const MapTile* in = key == tile_.key() ? &tile_ : find_tile_(key);
      blocks_[at] = in != nullptr ? in->block(block_of(first)) : nullptr;
      known_.set(at);
    }
    return blocks_[at];
  }

 private:
  const MapTile& tile_;
  const FindTile& find_tile_;
  CellIndex first_;
  const MapBlock& centre_;
  std::array<const MapBlock*, 27> blocks_{};
  std::bitset<27> known_;
};

bool PlaneFitter::refit(const MapTile& tile, std::size_t block_index, const SlotSet& waiting) {
  Surroundings around(tile, block_index, find_tile_);
  const auto fit_cell = [&](const MapCell& cell, PackedPlane& plane) { return fit(around, cell, plane); };
  return tile.block(block_index)->refit(waiting, fit_cell, scratch_);
}

// Moments of the cell and its 26 neighbours about the cell's centre. Same side only: the other side of a thin
// wall is another plane.
Moments PlaneFitter::neighbourhood(Surroundings& around, const MapCell& centre) const {
  const int side = centre.slot / kPlacesPerBlock;
  const CellIndex at = around.first() + offset_of(centre.slot % kPlacesPerBlock);
  const CellIndex first = at.array() - 1;
  const CellIndex last = at.array() + 1;
  MomentSum sum;
  for_each_block(first, last, [&](const CellIndex& block_first, const CellIndex& low, const CellIndex& high) {
    const MapBlock* block = around.block_at(block_first);
    if (block == nullptr) return;
    for_each_in_window(block->mask(), side, low, high, [&](int slot) {
      const MapCell& other = block->cells()[block->mask().rank(slot)];
      if (same_way(other, centre)) {
        const CellIndex offset = block_first + offset_of(slot % kPlacesPerBlock) - at;
        sum.add(other.moments, offset);
      }
    });
  });
  return sum.in_metres(cell_m_);
}

// Moments of the cube of 4 x 4 x 4 cells that contains the slot, about the centre of the slot's cell.
Moments PlaneFitter::cube_around(const MapBlock& block, int slot) const {
  const CellIndex centre = offset_of(slot % kPlacesPerBlock);
  MomentSum sum;
  for_each_in_cube(block.mask(), slot % kPlacesPerBlock, [&](int member) {
    const CellIndex offset = offset_of(member % kPlacesPerBlock) - centre;
    sum.add(block.cells()[block.mask().rank(member)].moments, offset);
  });
  return sum.in_metres(cell_m_);
}

// True if the noise of the plane's points reaches a face of the cell that the plane runs along: the points beyond are in
// the next cell, and the mean of those inside is off the surface.
bool PlaneFitter::cut_off(const Plane& plane) const {
  Eigen::Index axis = 0;
  plane.normal.cwiseAbs().maxCoeff(&axis);
  return std::abs(plane.mean[axis]) > 0.5F * cell_m_ - kNoiseReachM;
}

bool PlaneFitter::fit(Surroundings& around, const MapCell& cell, PackedPlane& packed) const {
  PlaneCriteria own = criteria_;
  own.max_normal_deviation_rad *= kOwnCellDeviationFactor;
  Plane plane;  // about the cell's centre
  const bool own_fits = fit_plane(cell.moments.in_metres(cell_m_), own, plane);
  if (!own_fits || cut_off(plane)) {
    Plane wider;
    if (fit_plane(neighbourhood(around, cell), criteria_, wider)) {
      plane = wider;
    } else if (!own_fits && !fit_plane(cube_around(around.centre(), cell.slot), criteria_, plane)) {
      return false;
    }
  }
  // The stored point is the cell's own mean, moved towards the plane. A plane far from the mean is not the cell's
  // own surface.
  const Eigen::Vector3f mean = cell.moments.mean_m(cell_m_);
  const float off_plane = plane.normal.dot(mean - plane.mean);
  if (std::abs(off_plane) > 2.0F * criteria_.max_thickness_m) {
    return false;
  }
  const float kept = own_share(static_cast<float>(cell.moments.count()), plane.thickness_m);
  const Eigen::Vector3f q_cell = mean - (1.0F - kept) * off_plane * plane.normal;
  const CellIndex offset = offset_of(cell.slot % kPlacesPerBlock);
  const Eigen::Vector3f centre_block = (offset.cast<float>().array() + 0.5F * (1 - kBlockCells)) * cell_m_;
  const bool away = plane.normal.dot(cell.facing_vector()) < 0.0F;
  packed = PackedPlane::of(centre_block + q_cell, away ? (-plane.normal).eval() : plane.normal, cell_m_);
  return true;
}

}  // namespace isobar
