// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_block.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isobar {

namespace {

// A plane that turns away from the ray by more than this is the other side of a thin wall.
constexpr float kOtherSide = -0.15F;
// Planes are fitted again when a quarter more is known.
constexpr int kRefitNumerator = 5;
constexpr int kRefitDenominator = 4;
constexpr std::size_t kStagedAtOnce = 24;

std::uint32_t sub_cell_bit(const Eigen::Vector3f& fraction) {
  const auto third = [](float f) {
    return static_cast<unsigned>(std::clamp(static_cast<int>(f * 3.0F), 0, 2));
  };
  return 1U << ((third(fraction.z()) * 3 + third(fraction.y())) * 3 + third(fraction.x()));
}

std::array<std::int8_t, 3> packed_direction(const Eigen::Vector3f& unit) {
  const auto pack = [](float v) {
    return static_cast<std::int8_t>(std::lround(std::clamp(v, -1.0F, 1.0F) * 127.0F));
  };
  return {pack(unit.x()), pack(unit.y()), pack(unit.z())};
}

// Memory grows by a sixteenth: cells are most of what the map holds.
template <typename T>
void reserve_one_more(std::vector<T>& list) {
  if (list.size() == list.capacity()) {
    list.reserve(list.size() + std::max<std::size_t>(4, list.size() / 16));
  }
}

}  // namespace

MapCell& MapBlock::find_or_add(int slot) {
  const std::size_t at = mask_.rank(slot);
  if (!mask_.has(slot)) {
    reserve_one_more(cells_);
    const auto added = cells_.insert(cells_.begin() + static_cast<std::ptrdiff_t>(at), MapCell{});
    added->slot = static_cast<std::uint16_t>(slot) & 0x7FFFU;
    mask_.insert(slot);
  }
  return cells_[at];
}

bool MapBlock::is_other_side(int slot, const Eigen::Vector3f& toward) const {
  const PackedPlane* plane = plane_at(slot);
  return plane != nullptr && plane->unit_normal().dot(toward) < kOtherSide;
}

int MapBlock::observe(int place, const Observation& observation) {
  const int slot = is_other_side(place, observation.toward) ? place + kPlacesPerBlock : place;
  MapCell& cell = find_or_add(slot);
  if (cell.moments.count == 0) {
    cell.toward = packed_direction(observation.toward);
  }
  cell.seen_through = static_cast<std::uint8_t>(cell.seen_through - (cell.seen_through > 0 ? 1 : 0));
  cell.occupied_sub_cells |= sub_cell_bit(observation.fraction);
  const int count = cell.moments.count;
  if (count >= observation.freeze) {
    return -1;
  }
  cell.intensity =
      static_cast<std::uint8_t>((cell.intensity * count + observation.intensity + count / 2) / (count + 1));
  cell.moments.add(observation.fraction);
  if (cell.waiting != 0) {
    return -1;
  }
  // A cell without a plane is tried again after as much.
  const bool enough = cell.moments.count * kRefitDenominator >= cell.fitted_count * kRefitNumerator ||
                      cell.moments.count >= observation.freeze;
  if (!enough) {
    return -1;
  }
  cell.waiting = 1;
  return slot;
}

void MapBlock::set_plane(int slot, const PackedPlane* plane) {
  MapCell& cell = cells_[mask_.rank(slot)];
  cell.waiting = 0;
  cell.fitted_count = cell.moments.count;
  if (plane == nullptr && plane_at(slot) == nullptr) {
    return;
  }
  if (staged_.empty()) {
    staged_.reserve(kStagedAtOnce);
  }
  staged_.push_back({slot, plane != nullptr, plane != nullptr ? *plane : PackedPlane{}});
  changed_ = true;
}

std::size_t MapBlock::remove_seen_through(std::uint8_t limit) {
  const auto gone = [limit](const MapCell& cell) { return cell.seen_through > limit; };
  const std::size_t before = cells_.size();
  for (const MapCell& cell : cells_) {
    if (gone(cell)) {
      mask_.erase(cell.slot);
      changed_ = changed_ || plane_at(cell.slot) != nullptr;
    }
  }
  std::erase_if(cells_, gone);
  return before - cells_.size();
}

void MapBlock::publish() {
  if (!changed_) {
    return;
  }
  changed_ = false;
  std::sort(staged_.begin(), staged_.end(), [](const Staged& a, const Staged& b) { return a.slot < b.slot; });
  auto next = std::make_shared<PlaneBlock>();
  std::size_t most = staged_.size() + (planes_ ? planes_->planes.size() : 0);
  next->planes.reserve(std::min(most, cells_.size()));
  auto staged = staged_.begin();
  for (const MapCell& cell : cells_) {
    while (staged != staged_.end() && staged->slot < cell.slot) ++staged;
    const PackedPlane* plane = plane_at(cell.slot);
    if (staged != staged_.end() && staged->slot == cell.slot) {
      plane = staged->has_plane ? &staged->plane : nullptr;
    }
    if (plane != nullptr) {
      next->mask.mark(cell.slot);
      next->planes.push_back(*plane);
    }
  }
  next->mask.count_ranks();
  planes_ = next->planes.empty() ? nullptr : std::move(next);
  staged_ = std::vector<Staged>();  // memory too: most blocks are seldom changed again
}

void MapBlock::restore(std::vector<MapCell> cells, std::shared_ptr<const PlaneBlock> planes) {
  *this = MapBlock{};
  cells_ = std::move(cells);
  for (const MapCell& cell : cells_) {
    mask_.mark(cell.slot);
  }
  mask_.count_ranks();
  planes_ = std::move(planes);
}

std::size_t MapBlock::memory_bytes() const {
  std::size_t bytes =
      sizeof(MapBlock) + cells_.capacity() * sizeof(MapCell) + staged_.capacity() * sizeof(Staged);
  if (planes_) {
    bytes += sizeof(PlaneBlock) + planes_->planes.capacity() * sizeof(PackedPlane);
  }
  return bytes;
}

}  // namespace isobar
