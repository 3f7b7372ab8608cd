// SPDX-License-Identifier: BSD-3-Clause
// Floors and grids of a map that grows while the robot drives.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/floors/find_floors.hpp"
#include "core/floors/first_arrival.hpp"
#include "core/floors/floor_grid.hpp"
#include "core/floors/packed_points.hpp"
#include "core/map/map_point.hpp"
#include "core/map/tile_key.hpp"

namespace isobar {

/// Keeps the points of all tiles and the path, and finds floors and grids in them. Bounded: of tiles beyond
/// Limits::points, the farthest from the robot in plan, only the ground is kept; a path of more than Limits::places loses
/// every second one of them. Not on the way of a scan: it allocates, and find() and grid() take 0.1 s for 50 m x 50 m.
class FloorMap {
 public:
  struct Limits {
    std::size_t points = 6'000'000;  ///< 72 MB
    std::size_t places = 400'000;    ///< of the path: 40 km at first
    double grid_cells =
        7'600.0;  ///< along one edge of a grid; a larger floor has that part of it around the robot
  };

  explicit FloorMap(const GridConfig& config) : FloorMap(config, Limits()) {}
  FloorMap(const GridConfig& config, const Limits& limits) : config_(config), limits_(limits) {}

  /// Takes other settings of the grid.
  void configure(const GridConfig& config) { config_ = config; }
  /// Replaces the points of a tile.
  void set_tile(const TileKey& key, std::span<const MapPoint> points);
  /// The map has been laid anew: its tiles come again. Floors and way stay until the next find(): corrections move them by
  /// decimetres.
  void forget_tiles();
  /// The robot has driven on, to a place of base_link in the map frame [m].
  void drive_to(const Eigen::Vector3d& p_map_base);

  /// As drive_to(), of a height that tells floors apart: on a floor that is not known, a provisional one is opened, see
  /// FirstArrival. True if floors() has one more.
  bool arrive_at(std::int64_t stamp_ns, const Eigen::Vector3d& p_map_base);

  /// Finds the floors anew, in all tiles and the whole path.
  void find();
  /// Of the last find(), and of arrive_at() since.
  [[nodiscard]] const Floors& floors() const { return floors_; }
  /// Grid of a floor of floors(), with the tiles as they are, and the ground of the last find().
  /// @throws DataError when it is too large
  [[nodiscard]] OccupancyGrid grid(const Floor& floor) const;

  [[nodiscard]] std::size_t point_count() const { return points_; }
  [[nodiscard]] std::size_t place_count() const { return path_.size(); }

 private:
  struct Tile {
    PackedPoints points;
    Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
    bool is_whole = true;  ///< false: only the ground is kept
  };

  void keep_limit();
  void thin_path();
  [[nodiscard]] std::vector<TileKey> keys() const { return TileKey::sorted(tiles_); }
  [[nodiscard]] OccupancyGrid grid_around(const Floor& floor, double reach_m) const;

  GridConfig config_;
  Limits limits_;
  std::unordered_map<TileKey, Tile, TileKey::Hash> tiles_;
  std::size_t points_ = 0;
  std::vector<Eigen::Vector3d> path_;  ///< the last place is the newest, at any distance from the one before
  double spacing_m_ = 0.1;             ///< of the path's other places
  GroundColumns ground_;
  Eigen::AlignedBox2d extent_m_;  ///< of ground_ and path
  Floors floors_;
  FirstArrival arrival_;
};

}  // namespace isobar
