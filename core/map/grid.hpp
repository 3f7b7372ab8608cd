// SPDX-License-Identifier: BSD-3-Clause
// Grid of the map: a block is 8 x 8 x 8 cells, a tile 4 x 4 x 4 blocks. With cells of 0.275 m, a block is
// 2.2 m and a tile 8.8 m wide.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "core/map/tile_key.hpp"

namespace isobar {

inline constexpr int kBlockCells = 8;  ///< cells along the edge of a block
inline constexpr int kTileBlocks = 4;  ///< blocks along the edge of a tile
inline constexpr int kTileCells = kBlockCells * kTileBlocks;
inline constexpr std::size_t kBlocksPerTile = std::size_t{kTileBlocks} * kTileBlocks * kTileBlocks;
inline constexpr int kPlacesPerBlock = kBlockCells * kBlockCells * kBlockCells;

/// Index of a cell: floor(p_map / cell_m) per axis.
using CellIndex = Eigen::Vector3i;

/// floor(value) as an integer; |value| must be below 2^31.
template <typename Real>
[[nodiscard]] inline std::int32_t floor_int(Real value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (static_cast<Real>(truncated) > value ? 1 : 0);
}

/// Tile of a cell.
[[nodiscard]] inline TileKey tile_of(const CellIndex& cell) {
  return {cell.x() >> 5, cell.y() >> 5, cell.z() >> 5};
}

/// Index of the cell's block in its tile, 0 … 63: x runs fastest.
[[nodiscard]] inline std::size_t block_of(const CellIndex& cell) {
  const int block =
      (((cell.z() >> 3 & 3) * kTileBlocks) + (cell.y() >> 3 & 3)) * kTileBlocks + (cell.x() >> 3 & 3);
  return static_cast<std::size_t>(block);
}

/// Index of the cell in its block ("place"), 0 … 511: x runs fastest.
[[nodiscard]] inline int place_of(const CellIndex& cell) {
  return (((cell.z() & 7) * kBlockCells) + (cell.y() & 7)) * kBlockCells + (cell.x() & 7);
}

/// First cell of a tile: the one with the lowest indices.
[[nodiscard]] inline CellIndex first_cell(const TileKey& key) {
  return {key.x * kTileCells, key.y * kTileCells, key.z * kTileCells};
}

/// Edge of a tile [m]; `cell_m`: edge of a cell.
[[nodiscard]] inline double tile_m(float cell_m) { return static_cast<double>(cell_m) * kTileCells; }

/// Centre of a tile in the map frame [m]; `cell_m`: edge of a cell.
[[nodiscard]] inline Eigen::Vector3d centre_of(const TileKey& key, float cell_m) {
  return (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * tile_m(cell_m);
}

/// First cell of a tile's block; `block`: 0 … 63, as from block_of().
[[nodiscard]] inline CellIndex first_cell(const TileKey& key, std::size_t block) {
  const int b = static_cast<int>(block);
  return first_cell(key) + kBlockCells * CellIndex(b % kTileBlocks, b / kTileBlocks % kTileBlocks,
                                                   b / (kTileBlocks * kTileBlocks));
}

/// First cell of the block that contains `cell`.
[[nodiscard]] inline CellIndex first_of_block(const CellIndex& cell) {
  return {cell.x() & ~7, cell.y() & ~7, cell.z() & ~7};
}

/// Offset of a place (0 … 511) from the first cell of its block, in cells, 0 … 7 per axis.
[[nodiscard]] inline CellIndex offset_of(int place) {
  return {place % kBlockCells, place / kBlockCells % kBlockCells, place / (kBlockCells * kBlockCells)};
}

/// Local frame for single precision: axes of the map frame, origin at the corner of a tile near the robot.
/// Coordinates stay small: at 100 m a float resolves 10 um.
struct LocalFrame {
  CellIndex origin_cell = CellIndex::Zero();
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();  ///< the corner of origin_cell [m]
  float cell_m = 0.25F;                                  ///< edge of a cell [m]

  LocalFrame() = default;
  /// Frame at the corner of the tile that contains `p_map` [m], |p_map| < 1e8 m. `cell_edge_m`: 0.1 … 1 m.
  LocalFrame(const Eigen::Vector3d& p_map, float cell_edge_m) : cell_m(cell_edge_m) {
    const double edge_m = tile_m(cell_m);
    const CellIndex tile(floor_int(p_map.x() / edge_m), floor_int(p_map.y() / edge_m),
                         floor_int(p_map.z() / edge_m));
    origin_cell = tile * kTileCells;
    origin_map = tile.cast<double>() * edge_m;
  }

  [[nodiscard]] Eigen::Vector3f to_local(const Eigen::Vector3d& p_map) const {
    return (p_map - origin_map).cast<float>();
  }
  [[nodiscard]] Eigen::Vector3d to_map(const Eigen::Vector3f& p_local) const {
    return origin_map + p_local.cast<double>();
  }
  /// Cell that contains `p_local`.
  [[nodiscard]] CellIndex cell_of(const Eigen::Vector3f& p_local) const {
    const Eigen::Vector3f scaled = p_local / cell_m;
    return origin_cell + CellIndex(floor_int(scaled.x()), floor_int(scaled.y()), floor_int(scaled.z()));
  }
  /// Corner of a cell with the lowest coordinates [m].
  [[nodiscard]] Eigen::Vector3f corner_local(const CellIndex& cell) const {
    return (cell - origin_cell).cast<float>() * cell_m;
  }
};

}  // namespace isobar
