// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/known_map.hpp"

#include <utility>

#include "core/map/map_tile.hpp"
#include "core/map/plane_hash.hpp"

namespace isobar {

KnownMap::KnownMap(float cell_m, std::uint32_t session) : cell_m_(cell_m), session_(session) {}

KnownMap::KnownMap(std::span<const MapPoint> points, std::shared_ptr<const MapSnapshot> snapshot)
    : cell_m_(snapshot->cell_m()), session_(snapshot->session()), snapshot_(std::move(snapshot)) {
  structure_.set_points(points);
}

bool KnownMap::add_tile(const TileKey& key, std::span<const std::byte> bytes) {
  MapTile tile(key);
  if (!tile.restore(bytes, cell_m_)) return false;
  points_.clear();
  tile.append_points(cell_m_, points_);
  structure_.set_tile(key, points_);
  tile.publish();
  std::erase_if(planes_, [&](const auto& known) { return known->key == key; });
  if (tile.planes()->plane_count > 0) planes_.push_back(tile.planes());
  return true;
}

void KnownMap::finish() { snapshot_ = std::make_shared<const PlaneHash>(planes_, cell_m_, session_); }

}  // namespace isobar
