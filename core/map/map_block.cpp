// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_block.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isobar {

namespace {

// A point seen from behind the cell's plane belongs to the other side of a thin wall: cosine of the angle
// between normal and direction to the lidar, below zero so that grazing rays stay on the near side.
constexpr float kOtherSideCosine = -0.15F;
// A plane is refitted when the number of its cell's points has grown by this factor. Over 24 recordings this
// is as accurate as a refit after every growth by an eighth: most planes also use the points of neighbouring
// cells, which are up to date at every fit.
constexpr int kRefitFactor = 4;

std::uint32_t sub_cell_bit(const Eigen::Vector3f& fraction) {
  const auto third = [](float f) {
    return static_cast<unsigned>(std::clamp(static_cast<int>(f * 3.0F), 0, 2));
  };
  return 1U << ((third(fraction.z()) * 3 + third(fraction.y())) * 3 + third(fraction.x()));
}

// Grows the capacity by 1/16 instead of doubling it: cells dominate the memory of the map.
template <typename T>
void reserve_one_more(std::vector<T>& list) {
  if (list.size() == list.capacity()) {
    list.reserve(list.size() + std::max<std::size_t>(4, list.size() / 16));
  }
}

}  // namespace

void MapCell::set_facing(const Eigen::Vector3f& unit) {
  const auto pack = [](float v) {
    return static_cast<std::int8_t>(std::lround(std::clamp(v, -1.0F, 1.0F) * 127.0F));
  };
  facing = {pack(unit.x()), pack(unit.y()), pack(unit.z())};
}

MapCell& MapBlock::find_or_add(int slot) {
  const std::size_t at = mask_.rank(slot);
  if (!mask_.has(slot)) {
    reserve_one_more(cells_);
    const auto added = cells_.insert(cells_.begin() + static_cast<std::ptrdiff_t>(at), MapCell{});
    added->slot = static_cast<std::uint16_t>(slot);
    mask_.insert(slot);
  }
  return cells_[at];
}

int MapBlock::observe(int place, const Observation& observation) {
  const MapCell* near_side = find(place);
  const bool other_side = near_side != nullptr && near_side->has_plane != 0 &&
                          near_side->facing_vector().dot(observation.toward) < kOtherSideCosine;
  const int slot = other_side ? place + kPlacesPerBlock : place;
  MapCell& cell = find_or_add(slot);
  const int count = cell.moments.count();
  if (count == 0) {
    cell.set_facing(observation.toward);
  }
  cell.seen_through = static_cast<std::uint8_t>(cell.seen_through - (cell.seen_through > 0 ? 1 : 0));
  cell.occupied_sub_cells |= sub_cell_bit(observation.fraction);
  if (count >= observation.freeze) {
    return kNoSlot;
  }
  cell.intensity =
      static_cast<std::uint8_t>((cell.intensity * count + observation.intensity + count / 2) / (count + 1));
  cell.moments.add(observation.fraction);
  // Applies to cells without a plane as well: after the same growth the fit is tried again.
  const bool enough = count + 1 >= cell.fitted_count * kRefitFactor || count + 1 >= observation.freeze;
  return enough ? slot : kNoSlot;
}

std::size_t MapBlock::remove_seen_through(std::uint8_t limit) {
  const auto gone = [limit](const MapCell& cell) { return cell.seen_through > limit; };
  const std::size_t before = cells_.size();
  for (const MapCell& cell : cells_) {
    if (gone(cell)) mask_.erase(cell.slot);
  }
  std::erase_if(cells_, gone);
  return before - cells_.size();
}

void MapBlock::restore(std::vector<MapCell> cells, std::shared_ptr<const PlaneBlock> planes) {
  *this = MapBlock{};
  cells_ = std::move(cells);
  planes_ = std::move(planes);
  for (MapCell& cell : cells_) {
    mask_.mark(cell.slot);
    const PackedPlane* plane = plane_at(cell.slot);
    cell.has_plane = plane != nullptr ? 1 : 0;
    if (plane != nullptr) cell.set_facing(plane->unit_normal());
  }
  mask_.update_ranks();
}

}  // namespace isobar
