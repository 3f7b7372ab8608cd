// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/map_export.hpp"

#include <vector>

#include "core/map/map_tile.hpp"

namespace isobar::files {

namespace {

bool overlap(const MapBox& a, const MapBox& b, double margin_m) {
  return (a.lowest.array() <= b.highest.array() + margin_m).all() &&
         (b.lowest.array() <= a.highest.array() + margin_m).all();
}

}  // namespace

MapBox MapBox::of_tile(const TileKey& key, double tile_m) {
  const Eigen::Vector3d lowest = Eigen::Vector3d(key.x, key.y, key.z) * tile_m;
  return {lowest, lowest.array() + tile_m};
}

std::string tile_name(const TileKey& key) {
  return "tile (" + std::to_string(key.x) + ", " + std::to_string(key.y) + ", " + std::to_string(key.z) + ")";
}

MapExport export_map(FileTileStore& store, const MapHeader& header, const std::optional<MapBox>& box,
                     PlyWriter& ply) {
  MapExport done;
  std::vector<std::byte> bytes;
  std::vector<MapPoint> points;
  for (const TileKey& key : store.keys()) {
    // Margin: a point on the plane of a cell at the tile's edge may lie up to one cell outside.
    if (box && !overlap(MapBox::of_tile(key, header.tile_m), *box, header.cell_m)) continue;
    points.clear();
    if (!store.take(key, bytes) || !MapTile::append_stored_points(bytes, points)) {
      if (done.unreadable++ == 0) done.first_unreadable = tile_name(key);
      continue;
    }
    ++done.tiles;
    for (const MapPoint& point : points) {
      if (box && !box->contains(point.p_map)) continue;
      const Eigen::Vector3f p_map = point.p_map.cast<float>();
      ply.add(p_map.x(), p_map.y(), p_map.z(), point.intensity);
      ++done.points;
    }
  }
  return done;
}

}  // namespace isobar::files
