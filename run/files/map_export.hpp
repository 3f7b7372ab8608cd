// SPDX-License-Identifier: BSD-3-Clause
// The map as points, for viewers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "run/files/point_file.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "run/tile_store/map_folder.hpp"

namespace isobar::files {

/// Axis-aligned box in the map frame [m], closed: points on a face are inside.
struct MapBox {
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero();
  Eigen::Vector3d highest = Eigen::Vector3d::Zero();

  /// Nominal box of a tile. Points in the cells at its edge may lie up to one cell outside.
  [[nodiscard]] static MapBox of_tile(const TileKey& key, double tile_m);

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_map) const {
    return (p_map.array() >= lowest.array()).all() && (p_map.array() <= highest.array()).all();
  }
};

/// "tile (x, y, z)"
[[nodiscard]] std::string tile_name(const TileKey& key);

struct MapExport {
  std::uint64_t tiles = 0;       ///< read
  std::uint64_t points = 0;      ///< written, or visited
  std::uint64_t unreadable = 0;  ///< damaged tiles, and tiles that this program cannot decode
  std::string first_unreadable;  ///< tile_name()
};

/// Calls `visit` with the points of each tile that may have points in the box, in the order of the tiles' keys: one
/// tile in memory at a time. Unreadable tiles are counted and left out.
/// @param box nothing: all tiles
MapExport for_each_tile(FileTileStore& store, const MapHeader& header, const std::optional<MapBox>& box,
                        const std::function<void(std::span<const MapPoint>)>& visit);

/// Writes the points of all tiles to `file`, in the order of for_each_tile(): equal maps give equal files.
/// @param box only points inside; nothing: all points
/// @throws ServiceError when `file` cannot be written
MapExport export_map(FileTileStore& store, const MapHeader& header, const std::optional<MapBox>& box,
                     PointFile& file);

}  // namespace isobar::files
