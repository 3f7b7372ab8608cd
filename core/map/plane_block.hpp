// SPDX-License-Identifier: BSD-3-Clause
// Planes of a block and of a tile as the registration reads them: immutable, shared between snapshots.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/map/cell_mask.hpp"
#include "core/map/grid.hpp"

namespace isobar {

/// Plane in 12 bytes: a point q on it and its unit normal towards the observer, in fixed point.
struct PackedPlane {
  std::array<std::int16_t, 3> q{};       ///< from the block's centre, in units of the block's edge / 2^15
  std::array<std::int16_t, 3> normal{};  ///< in units of 1 / 32767

  friend bool operator==(const PackedPlane&, const PackedPlane&) = default;

  /// `q_block`: from the block's centre [m], at most one edge of the block away per axis.
  static PackedPlane of(const Eigen::Vector3f& q_block, const Eigen::Vector3f& unit_normal, float cell_m) {
    const auto pack = [](float value) {
      return static_cast<std::int16_t>(std::lround(std::clamp(value, -32767.0F, 32767.0F)));
    };
    const float per_m = 32768.0F / (cell_m * kBlockCells);
    PackedPlane plane;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      plane.q[static_cast<std::size_t>(axis)] = pack(q_block[axis] * per_m);
      plane.normal[static_cast<std::size_t>(axis)] = pack(unit_normal[axis] * 32767.0F);
    }
    return plane;
  }

  /// The plane's point, from the block's centre [m].
  [[nodiscard]] Eigen::Vector3f q_block(float cell_m) const {
    return Eigen::Vector3f(q[0], q[1], q[2]) * (cell_m * kBlockCells / 32768.0F);
  }
  [[nodiscard]] Eigen::Vector3f unit_normal() const {
    return Eigen::Vector3f(normal[0], normal[1], normal[2]) * (1.0F / 32767.0F);
  }
};
static_assert(sizeof(PackedPlane) == 12);

/// Planes of a block.
struct PlaneBlock {
  PlaneBlock() = default;
  PlaneBlock(const CellMask& of_planes, std::vector<PackedPlane> in_order)
      : mask(of_planes), planes(std::move(in_order)) {}

  CellMask mask;                    ///< slots that have a plane
  std::vector<PackedPlane> planes;  ///< one per slot of `mask`, in order of slots

  /// Plane of a slot; null if it has none.
  [[nodiscard]] const PackedPlane* find(int slot) const {
    return mask.has(slot) ? &planes[mask.rank(slot)] : nullptr;
  }
};

/// Planes of a tile; blocks without planes are null.
struct PlaneTile {
  TileKey key;
  std::array<std::shared_ptr<const PlaneBlock>, kBlocksPerTile> blocks;
  std::size_t plane_count = 0;
};

/// Centre of a block [m]; `first`: its first cell.
[[nodiscard]] inline Eigen::Vector3f block_centre_local(const LocalFrame& frame, const CellIndex& first) {
  return frame.corner_local(first).array() + 0.5F * kBlockCells * frame.cell_m;
}

}  // namespace isobar
