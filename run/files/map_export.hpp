// SPDX-License-Identifier: BSD-3-Clause
// The map as points: a file of a run's store for viewers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "run/files/replay_output.hpp"
#include "run/tile_store/map_folder.hpp"
#include "run/tile_store/tile_store.hpp"

namespace isobar {

/// A box along the axes of the map frame [m]; its faces belong to it.
struct MapBox {
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero();
  Eigen::Vector3d highest = Eigen::Vector3d::Zero();

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_map) const {
    return (p_map.array() >= lowest.array()).all() && (p_map.array() <= highest.array()).all();
  }
};

/// The space of a tile [m].
[[nodiscard]] MapBox box_of(const TileKey& key, double tile_m);

/// What an export did.
struct MapExport {
  std::uint64_t tiles = 0;
  std::uint64_t points = 0;
  std::uint64_t unreadable = 0;  ///< tiles that are damaged, or whose bytes mean nothing to this program
  std::string first_unreadable;  ///< "tile (x, y, z)"
};

/// "tile (x, y, z)"
[[nodiscard]] std::string name_of(const TileKey& key);

/// Writes the points of all tiles to `ply`, tile by tile in the order of their keys: one tile in memory at a
/// time, and equal maps give equal files. Of a `box` only what is in it. Throws ServiceError where `ply`
/// cannot be written; tiles that cannot be read are counted and left out.
MapExport export_map(TileStore& store, const MapHeader& header, const std::optional<MapBox>& box,
                     files::PlyWriter& ply);

}  // namespace isobar
