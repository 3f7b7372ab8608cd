// SPDX-License-Identifier: BSD-3-Clause
// Floors and grids of a map on disk, tile by tile.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "core/floors/find_floors.hpp"
#include "core/floors/floor_grid.hpp"
#include "run/files/map_export.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar::files {

/// The trajectory of the run that made a map, beside the map's folder (of the map frame of the folder's number): as
/// estimated live, since the tiles stand where it laid them. Empty where there is none.
[[nodiscard]] std::filesystem::path trajectory_of_map(const std::filesystem::path& map_directory);

/// Positions of a trajectory [m]; none without a file, or as long as it holds no pose.
/// @throws DataError "file:line: rule" when it breaks the format
[[nodiscard]] std::vector<Eigen::Vector3d> path_of(const std::filesystem::path& trajectory);

/// What a map tells about its floors.
struct StoredFloors {
  GroundColumns ground;
  Floors floors;
  MapExport read;  ///< tiles, points, unreadable tiles
};

/// Reads all tiles once.
[[nodiscard]] StoredFloors find_stored_floors(FileTileStore& store, const std::vector<Eigen::Vector3d>& path);

/// Grid of one floor: reads the tiles around it once more.
/// @param config surface_m is taken from the map
[[nodiscard]] OccupancyGrid stored_floor_grid(FileTileStore& store, const StoredFloors& found,
                                              const Floor& floor, const std::vector<Eigen::Vector3d>& path,
                                              GridConfig config);

}  // namespace isobar::files
