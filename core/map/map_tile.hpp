// SPDX-License-Identifier: BSD-3-Clause
// One tile of the map under construction: cells with the moments of their points, and points to keep.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/map/map_point.hpp"
#include "core/map/plane_cell.hpp"
#include "core/map/tile_index.hpp"

namespace isobar {

/// A cell of the grid, or one side of it: a wall thinner than a cell has two.
struct MapCell {
  Moments moments;                                   ///< about the cell's centre
  Eigen::Vector3f toward = Eigen::Vector3f::Zero();  ///< direction to its first observer
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< of the plane, towards the observer
  Eigen::Vector3f q_tile = Eigen::Vector3f::Zero();  ///< a point on the plane
  std::uint32_t key = 0;                             ///< place in the tile and side
  std::uint32_t occupied_sub_cells = 0;              ///< one bit each of 3 x 3 x 3
  float fitted_count = 0.0F;                         ///< moments.count when the plane was fitted
  std::uint16_t seen_through = 0;                    ///< rays that passed, less observations
  bool has_plane = false;
  bool touched = false;  ///< waits for a fit
};

/// Cells, points and coarse moments of one tile. Positions are relative to the tile's origin.
class MapTile {
 public:
  /// Coarse cells of 1 m give far walls a normal, where the rings are farther apart than the cells.
  static constexpr int kCoarsePerEdge = 8;
  static constexpr std::size_t kCoarseCells = std::size_t{kCoarsePerEdge} * kCoarsePerEdge * kCoarsePerEdge;

  /// `cells_per_edge`: 8 … 80.
  MapTile(const TileKey& key, int cells_per_edge);

  /// Observes a point: `toward` is the unit direction to the sensor. Returns the cell's index if it now waits
  /// for a fit and did not before, else -1. `freeze`: see MapConfig::freeze_observations.
  std::ptrdiff_t observe(const Eigen::Vector3f& p_tile, const Eigen::Vector3f& toward, std::uint8_t intensity,
                         float freeze);

  /// True if no plane is known within the coarse cell of `p_tile`.
  [[nodiscard]] bool unknown_at(const Eigen::Vector3f& p_tile) const;

  /// Cell `x, y, z` (0 … cells_per_edge-1), first or second side; null if empty.
  [[nodiscard]] const MapCell* cell_at(int x, int y, int z, int side) const;

  /// Drops the observations of cells chosen by seen_through > limit and their points; returns how many.
  std::size_t remove_seen_through(std::uint16_t limit);

  /// Makes the search structure anew if planes changed. Returns true if it did.
  bool rebuild_index();

  void append_points(std::vector<MapPoint>& points) const;

  [[nodiscard]] Eigen::Vector3f cell_centre_tile(std::uint32_t cell_key) const;
  [[nodiscard]] Eigen::Vector3i cell_coordinates(std::uint32_t cell_key) const;
  /// Moments of the coarse cell that holds `p_tile`, about `centre_tile`.
  [[nodiscard]] const Moments& coarse_at(const Eigen::Vector3f& p_tile, Eigen::Vector3f& centre_tile) const;

  [[nodiscard]] const TileKey& key() const { return key_; }
  [[nodiscard]] std::vector<MapCell>& cells() { return cells_; }
  [[nodiscard]] const std::vector<MapCell>& cells() const { return cells_; }
  [[nodiscard]] const std::shared_ptr<const TileIndex>& index() const { return index_; }
  /// Sets or takes away a cell's plane.
  void set_plane(MapCell& cell, const Plane& plane);
  void clear_plane(MapCell& cell);

 private:
  struct KeptPoint {
    Eigen::Vector3f p_tile;
    std::uint32_t cell = 0;
    std::uint8_t intensity = 0;
  };

  [[nodiscard]] static std::size_t coarse_index(const Eigen::Vector3f& p_tile, Eigen::Vector3f& centre_tile);
  [[nodiscard]] std::uint32_t key_of(const Eigen::Vector3f& p_tile) const;
  [[nodiscard]] std::ptrdiff_t find(std::uint32_t cell_key) const;
  MapCell& find_or_add(std::uint32_t cell_key);
  void grow_table();
  void keep_point(MapCell& cell, const Eigen::Vector3f& p_centre, const Eigen::Vector3f& p_tile,
                  std::uint8_t intensity);

  TileKey key_;
  int cells_per_edge_;
  float cell_m_;
  std::vector<MapCell> cells_;
  std::vector<std::int32_t> table_;  // open addressing on the cell key; -1 is empty
  std::vector<KeptPoint> points_;
  std::array<Moments, kCoarseCells> coarse_{};
  std::array<std::uint16_t, kCoarseCells> coarse_planes_{};
  std::shared_ptr<const TileIndex> index_;
  bool changed_ = false;
};

}  // namespace isobar
