// SPDX-License-Identifier: BSD-3-Clause
// Density control: which points of a scan go to the map and which take part in the ICP.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/estimates.hpp"
#include "core/registration/voxel_filter.hpp"

namespace isobar {

/// Chooses points well spread in space, near and far. A scan may come whole, to thin(), or in parts:
///
///     sampler.start(out);
///     for (each part) sampler.add(part, out);
///     sampler.finish();
class Sampler {
 public:
  /// `map_voxel_m`: at most one point of the map a voxel; `sample_points`: at most so many take part.
  Sampler(double map_voxel_m, std::size_t sample_points);

  /// Begins a scan: out.point_count becomes 0.
  void start(RegisteredScan& out);
  /// Appends to out.points the first of `points` (p_base) in each voxel that is empty yet. `points` may lie
  /// in out.points itself. All parts of a scan together: at most RegisteredScan::kMaxPoints.
  void add(std::span<const ScanPoint> points, RegisteredScan& out);
  /// Picks the sample from the points that were kept.
  void finish();

  /// All of it, in place on out.points.
  void thin(RegisteredScan& out);

  /// The sample of the last scan, p_base.
  [[nodiscard]] std::span<const Eigen::Vector3f> sample() const { return sample_; }

 private:
  VoxelGrid map_grid_;
  std::size_t sample_points_;
  float finest_voxel_m_;
  float sample_voxel_m_;  // follows the scene, so that the sample's size stays near sample_points_
  VoxelGrid sample_grid_;
  VoxelFilter map_filter_;
  VoxelFilter sample_filter_;
  std::array<std::uint64_t, 256> last_voxel_{};  // by ring
  std::vector<Eigen::Vector3f> sample_;
  std::vector<Eigen::Vector3f> candidates_;
};

}  // namespace isobar
