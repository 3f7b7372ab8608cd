// SPDX-License-Identifier: BSD-3-Clause
// Voxel grid and hash set of voxels: the first point of each voxel is kept.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/samples.hpp"

namespace isobar {

/// A grid of cubes that reaches 500 m from the origin.
class VoxelGrid {
 public:
  /// Result of voxel_of() for points beyond the grid's reach or not finite.
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  /// `edge_m`: edge of a voxel, > 0; at least 3 cm are used.
  explicit VoxelGrid(float edge_m);

  /// Number of the voxel that holds the point; equal for two points if and only if they share one.
  [[nodiscard]] std::uint64_t voxel_of(const ScanPoint& p) const {
    const bool inside = std::abs(p.x_m) < kReachM && std::abs(p.y_m) < kReachM && std::abs(p.z_m) < kReachM;
    return inside ? cell(p.x_m) << (2U * kBitsPerAxis) | cell(p.y_m) << kBitsPerAxis | cell(p.z_m) : kNowhere;
  }

 private:
  static constexpr float kReachM = 500.0F;
  static constexpr unsigned kBitsPerAxis = 15;

  // Conversion by way of a signed 32-bit integer: one instruction (cvttss2si).
  [[nodiscard]] std::uint64_t cell(float along_m) const {
    return static_cast<std::uint64_t>(static_cast<std::int32_t>((along_m + kReachM) * voxels_per_m_));
  }

  float voxels_per_m_;
};

/// Hash set of voxels. Memory of fixed size; a pass uses a table of the size that its voxels need, so that
/// the table of a usual scan stays in the L2 cache.
class VoxelFilter {
 public:
  /// `max_voxels`: capacity, at most 131 000.
  explicit VoxelFilter(std::size_t max_voxels);

  /// Empties the set.
  void start();
  /// Inserts `voxel`. True if it is new since start(); false always once the set is full.
  bool first(std::uint64_t voxel);

 private:
  // Entry of the table: index in voxels_ plus one, then kTagBits bits of the hash, which reject most other
  // voxels without reading voxels_. Zero: empty slot.
  static constexpr unsigned kTagBits = 15;

  void resize(std::size_t slots);
  void insert(std::uint64_t voxel, std::size_t place);

  std::vector<std::uint64_t> voxels_;  // in order of arrival
  std::vector<std::uint32_t> table_;   // slots 0 … slot_mask_ are in use, at most half of them filled
  std::size_t max_voxels_;
  std::size_t slot_mask_ = 0;
};

}  // namespace isobar
