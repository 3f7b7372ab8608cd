// SPDX-License-Identifier: BSD-3-Clause
// Downsampling: which points of a scan go to the map and which take part in the ICP.
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

/// Voxel-grid downsampling, even in space near and far. A scan comes in parts:
///
///     sampler.start(out);
///     for (each part) sampler.add(part, out);
///     sampler.finish();
class Sampler {
 public:
  /// `map_voxel_m`: edge of the voxels, one point each for the map. `sample_points`: upper bound of sample().
  Sampler(double map_voxel_m, std::size_t sample_points);

  /// Begins a scan: sets out.point_count to 0.
  void start(RegisteredScan& out);
  /// Appends to out.points the first of `points` (p_base) in each voxel that is still empty. `points` may lie
  /// in out.points itself. All parts of a scan together: at most RegisteredScan::kMaxPoints.
  void add(std::span<const ScanPoint> points, RegisteredScan& out);
  /// Draws the sample from the points that were kept.
  void finish();

  /// The sample of the last scan, p_base.
  [[nodiscard]] std::span<const Eigen::Vector3f> sample() const { return sample_; }

 private:
  static constexpr std::size_t kPart = 512;
  /// A point whose voxel differs from that of the point before it on its ring.
  struct Arrival {
    std::uint64_t voxel;
    std::size_t index;  // in its part
  };

  void add_part(std::span<const ScanPoint> points, RegisteredScan& out);

  VoxelGrid map_grid_;
  std::size_t sample_points_;
  float finest_voxel_m_;
  float sample_voxel_m_;  // adapts to the scene, so that the sample's size stays near sample_points_
  VoxelGrid sample_grid_;
  VoxelFilter map_filter_;
  VoxelFilter sample_filter_;
  std::array<std::uint64_t, 256> last_voxel_{};  // by ring
  std::array<Arrival, kPart> arrivals_{};
  std::vector<Eigen::Vector3f> sample_;
  std::vector<Eigen::Vector3f> candidates_;
};

}  // namespace isobar
