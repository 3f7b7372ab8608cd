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
///     sampler.finish(out);
///
/// The voxel of a return decides whether the *next* return of its laser is kept, if that one lies beside it. The noise of
/// a kept point is then independent of its choice. Of a surface along a face of the grid, points chosen by their own voxel
/// would be the outliers on both sides, equal in number, and the surface would move onto the face: a floor follows the
/// tilt of the robot by half, and walls its yaw.
class Sampler {
 public:
  /// `map_voxel_m`: edge of the voxels, one point each for the map. `sample_points`: upper bound of sample().
  Sampler(double map_voxel_m, std::size_t sample_points);

  /// Begins a scan: sets out.point_count to 0.
  void start(RegisteredScan& out);
  /// Appends to out.points one of `points` (p_base, in the order of firing) for each voxel that is still empty; the last
  /// return of each laser waits. `points` may lie in out.points itself. All parts of a scan together: at most
  /// RegisteredScan::kMaxPoints.
  void add(std::span<const ScanPoint> points, RegisteredScan& out);
  /// Appends the returns that waited, and draws the sample from the points that were kept.
  void finish(RegisteredScan& out);

  /// The sample of the last scan, p_base.
  [[nodiscard]] std::span<const Eigen::Vector3f> sample() const { return sample_; }

 private:
  static constexpr std::size_t kPart = 512;
  static constexpr std::size_t kRings = 256;
  /// A return whose voxel differs from that of the return before it on its ring, and the return after it: places in
  /// window_.
  struct Arrival {
    std::uint64_t voxel;
    std::uint32_t at;
    std::uint32_t next;
  };
  /// The last return of a ring. `arrives`: its voxel differs from that of the return before it, 0 or 1.
  struct RingEnd {
    std::uint64_t voxel = VoxelGrid::kNowhere;
    std::uint32_t at = 0;
    std::uint32_t arrives = 0;
  };

  [[nodiscard]] bool beside(const ScanPoint& a, const ScanPoint& b) const;
  void keep(const Arrival& arrival, RegisteredScan& out);
  void choose_candidates(const RegisteredScan& out);
  void add_part(std::span<const ScanPoint> points, RegisteredScan& out);

  VoxelGrid map_grid_;
  float beside_m_;  // largest distance of two returns beside each other
  std::size_t sample_points_;
  float finest_voxel_m_;
  float sample_voxel_m_;  // adapts to the scene, so that the sample's size stays near sample_points_
  VoxelGrid sample_grid_;
  VoxelFilter map_filter_;
  VoxelFilter sample_filter_;
  std::vector<ScanPoint> deciders_;  // the return whose voxel decided, for each kept point
  std::array<ScanPoint, kRings + kPart>
      window_{};  // the last return of each ring before this part, and the part
  std::array<RingEnd, kRings> ends_{};
  std::size_t rings_ = 0;  // that the scan has
  std::array<Arrival, kPart> arrivals_{};
  std::vector<Eigen::Vector3f> sample_;
  std::vector<Eigen::Vector3f> candidates_;
};

}  // namespace isobar
