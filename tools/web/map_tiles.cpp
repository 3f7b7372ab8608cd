// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/map_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace isobar::web {
namespace {

constexpr std::uint32_t kMagic = 0x504d4249;  // "IBMP"
constexpr std::uint32_t kFormat = 1;

/// Mixes the bits of a number (the finaliser of SplitMix64).
std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

std::uint64_t hash_of(const TilePoint& point) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, point.data(), sizeof bits);
  return mixed(bits + 0x9e3779b97f4a7c15U);
}

static_assert(sizeof(TilePoint) == sizeof(std::uint64_t));

template <typename Value>
void append(Value value, std::string& out) {
  std::array<char, sizeof(Value)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(Value));  // all machines of Isobar are little-endian
  out.append(bytes.data(), bytes.size());
}

void append_tile(const TileIndex& index, std::uint32_t change, const std::vector<TilePoint>& points,
                 std::string& out) {
  for (const std::int32_t number : index) append(number, out);
  append(static_cast<std::uint32_t>(points.size()), out);
  append(change, out);
  for (const TilePoint& point : points) {
    for (const std::uint16_t value : point) append(value, out);
  }
}

}  // namespace

void MapDraft::add(double x_m, double y_m, double z_m, std::uint8_t intensity) {
  const std::array<double, 3> place{x_m, y_m, z_m};
  const bool is_sane = std::all_of(place.begin(), place.end(), [](double value) {
    return std::isfinite(value) && std::abs(value) < kFarthestM;
  });
  if (!is_sane || points_ >= kMostPoints) {
    ++left_out_;
    return;
  }
  TileIndex index{};
  TilePoint point{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double tile = std::floor(place[axis] / kTileEdgeM);
    index[axis] = static_cast<std::int32_t>(tile);
    const double steps = (place[axis] - tile * kTileEdgeM) / kTileStepM;
    point[axis] = static_cast<std::uint16_t>(std::clamp(steps, 0.0, 65'535.0));
  }
  point[3] = intensity;
  if (last_tile_ == nullptr || index != last_index_) {
    last_index_ = index;
    last_tile_ = &tiles_[index];
  }
  last_tile_->points.push_back(point);
  last_tile_->sum += hash_of(point);
  ++points_;
}

MapTiles::MapTiles(std::uint32_t epoch) { state_.epoch = std::max(epoch, 1U); }

void MapTiles::set(const TileIndex& index, Tile& tile, std::vector<TilePoint>&& points, std::uint64_t sum) {
  if (tile.change != 0) by_change_.erase(tile.change);
  state_.points += points.size();
  state_.points -= tile.points.size();
  tile.points = std::move(points);
  tile.points.shrink_to_fit();
  tile.sum = sum;
  tile.change = ++state_.change;
  by_change_[tile.change] = index;
}

void MapTiles::replace(MapDraft&& draft) {
  const std::lock_guard lock(mutex_);
  state_.left_out = draft.left_out_;
  for (auto& [index, tile] : tiles_) {
    if (!draft.tiles_.contains(index) && !tile.points.empty()) set(index, tile, {}, 0);
  }
  for (auto& [index, drafted] : draft.tiles_) {
    Tile& tile = tiles_[index];
    const bool is_equal =
        tile.change != 0 && tile.sum == drafted.sum && tile.points.size() == drafted.points.size();
    if (!is_equal) set(index, tile, std::move(drafted.points), drafted.sum);
  }
}

void MapTiles::thin_to(std::size_t points) {
  const std::lock_guard lock(mutex_);
  const std::size_t step = (state_.points + points - 1) / std::max<std::size_t>(points, 1);
  if (step <= 1) return;
  const std::uint64_t before = state_.points;
  state_.points = 0;
  std::size_t number = 0;
  for (auto& [index, tile] : tiles_) {
    std::erase_if(tile.points, [&](const TilePoint&) { return number++ % step != 0; });
    state_.points += tile.points.size();
  }
  state_.left_out += before - state_.points;
}

void MapTiles::start_over() {
  const std::lock_guard lock(mutex_);
  tiles_.clear();
  by_change_.clear();
  state_ = {state_.epoch + 1 == 0 ? 1 : state_.epoch + 1, 0, 0, 0};
}

MapState MapTiles::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::string MapTiles::changes_since(std::uint32_t epoch, std::uint32_t since,
                                    std::size_t answer_bytes) const {
  const std::lock_guard lock(mutex_);
  const std::uint32_t from = epoch == state_.epoch ? since : 0;
  std::string tiles;
  std::uint32_t count = 0;
  std::uint32_t reached = from;
  auto next = by_change_.upper_bound(from);
  for (; next != by_change_.end() && tiles.size() < answer_bytes; ++next, ++count) {
    const Tile& tile = tiles_.at(next->second);
    append_tile(next->second, tile.change, tile.points, tiles);
    reached = next->first;
  }
  std::string out;
  out.reserve(32 + tiles.size());
  append(kMagic, out);
  append(kFormat, out);
  append(state_.epoch, out);
  append(next == by_change_.end() ? state_.change : reached, out);
  append(static_cast<std::uint32_t>(next != by_change_.end()), out);
  append(static_cast<float>(kTileEdgeM), out);
  append(static_cast<float>(kTileStepM), out);
  append(count, out);
  return out + tiles;
}

}  // namespace isobar::web
