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

MapExport for_each_tile(FileTileStore& store, const MapHeader& header, const std::optional<MapBox>& box,
                        const std::function<void(std::span<const MapPoint>)>& visit) {
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
    done.points += points.size();
    visit(points);
  }
  return done;
}

MapExport export_map(FileTileStore& store, const MapHeader& header, const std::optional<MapBox>& box,
                     PointFile& file) {
  std::uint64_t written = 0;
  MapExport done = for_each_tile(store, header, box, [&](std::span<const MapPoint> points) {
    for (const MapPoint& point : points) {
      if (box && !box->contains(point.p_map)) continue;
      file.add(point);
      ++written;
    }
  });
  done.points = written;
  return done;
}

}  // namespace isobar::files
