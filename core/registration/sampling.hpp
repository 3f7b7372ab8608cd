// SPDX-License-Identifier: BSD-3-Clause
// Density control: which points of a scan go to the map and which take part in the ICP.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/estimates.hpp"

namespace isobar {

/// The first point in each voxel of a grid, in the order of the input. Memory of fixed size.
class VoxelFilter {
 public:
  /// `max_points`: of one pass.
  explicit VoxelFilter(std::size_t max_points);

  /// Starts a pass with voxels of `edge_m`, > 0.
  void start(float edge_m);
  /// True if `p` is the first in its voxel since start(). Voxels farther than 500 m hold nothing.
  bool first(const Eigen::Vector3f& p);

 private:
  std::vector<std::uint64_t> table_;  // pass and voxel in one word; entries of other passes are empty
  std::uint64_t pass_ = 0;
  std::size_t used_ = 0;
  float voxels_per_m_ = 1.0F;
};

/// Chooses points well spread in space, near and far.
class Sampler {
 public:
  /// `map_voxel_m`: at most one point of the map a voxel; `sample_points`: at most so many take part.
  Sampler(double map_voxel_m, std::size_t sample_points);

  /// Thins out.points (p_base) in place to one a voxel, then picks the sample from them.
  void thin(RegisteredScan& out);

  /// The sample of the last thin(), p_base.
  [[nodiscard]] std::span<const Eigen::Vector3f> sample() const { return sample_; }

 private:
  float map_voxel_m_;
  std::size_t sample_points_;
  float sample_voxel_m_;  // follows the scene, so that the sample's size stays near sample_points_
  VoxelFilter filter_;
  std::vector<Eigen::Vector3f> sample_;
  std::vector<Eigen::Vector3f> candidates_;
};

}  // namespace isobar
