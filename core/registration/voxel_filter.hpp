// SPDX-License-Identifier: BSD-3-Clause
// One point a voxel: which voxel a point lies in, and whether it is the first there.
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
  /// What voxel_of() says of points beyond the grid's reach or not finite.
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  /// `edge_m`: of a voxel, > 0. Finer than 3 cm is taken as 3 cm.
  explicit VoxelGrid(float edge_m);

  /// Number of the voxel that holds the point; equal for two points if and only if they share one.
  [[nodiscard]] std::uint64_t voxel_of(const ScanPoint& p) const {
    const bool inside = std::abs(p.x_m) < kReachM && std::abs(p.y_m) < kReachM && std::abs(p.z_m) < kReachM;
    return inside ? cell(p.x_m) << (2U * kBitsPerAxis) | cell(p.y_m) << kBitsPerAxis | cell(p.z_m) : kNowhere;
  }

 private:
  static constexpr float kReachM = 500.0F;
  static constexpr unsigned kBitsPerAxis = 15;

  // By way of 32 bits with a sign, which is one instruction.
  [[nodiscard]] std::uint64_t cell(float along_m) const {
    return static_cast<std::uint64_t>(static_cast<std::int32_t>((along_m + kReachM) * voxels_per_m_));
  }

  float voxels_per_m_;
};

/// A set of voxels. Memory of fixed size, of which a pass touches no more than its voxels need: the table of
/// a usual scan stays in the processor's second cache.
class VoxelFilter {
 public:
  /// `max_voxels`: in one pass, at most 131 000.
  explicit VoxelFilter(std::size_t max_voxels);

  /// Starts a pass with an empty set.
  void start();
  /// True if `voxel` is new since start(). Once max_voxels are there, none is.
  bool first(std::uint64_t voxel);

 private:
  // An entry of the table: the place in voxels_ plus one, then bits of the hash that tell most other voxels
  // apart without a look at voxels_. Zero: empty.
  static constexpr unsigned kTagBits = 15;

  void resize(std::size_t slots);
  void insert(std::uint64_t voxel, std::size_t place);

  std::vector<std::uint64_t> voxels_;  // in order of arrival
  std::vector<std::uint32_t> table_;   // the first slot_mask_ + 1 are in use, at most half of them filled
  std::size_t max_voxels_;
  std::size_t slot_mask_ = 0;
};

}  // namespace isobar
