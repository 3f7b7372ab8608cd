// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {
constexpr float kFinestVoxelM = 0.05F;
constexpr float kCoarsestVoxelM = 3.0F;
}  // namespace

Sampler::Sampler(double map_voxel_m, std::size_t sample_points)
    : map_grid_(static_cast<float>(map_voxel_m)),
      sample_points_(sample_points),
      finest_voxel_m_(std::max(static_cast<float>(map_voxel_m), kFinestVoxelM)),
      sample_voxel_m_(std::max(4.0F * static_cast<float>(map_voxel_m), kFinestVoxelM)),
      sample_grid_(sample_voxel_m_),
      map_filter_(RegisteredScan::kMaxPoints),
      sample_filter_(RegisteredScan::kMaxPoints) {
  sample_.reserve(sample_points);
  candidates_.reserve(RegisteredScan::kMaxPoints);
}

void Sampler::start(RegisteredScan& out) {
  out.point_count = 0;
  candidates_.clear();
  map_filter_.start();
  sample_filter_.start();
  sample_grid_ = VoxelGrid(sample_voxel_m_);
  last_voxel_.fill(VoxelGrid::kNowhere);
}

void Sampler::add(std::span<const ScanPoint> points, RegisteredScan& out) {
  for (const ScanPoint& point : points) {
    const std::uint64_t voxel = map_grid_.voxel_of(point);
    // Near the sensor one laser hits a voxel many times in a row: most points end here, before the table.
    std::uint64_t& last = last_voxel_[point.ring];
    if (voxel == last || voxel == VoxelGrid::kNowhere) {
      continue;
    }
    last = voxel;
    if (!map_filter_.first(voxel)) {
      continue;
    }
    out.points[out.point_count++] = point;
    if (sample_filter_.first(sample_grid_.voxel_of(point))) {
      candidates_.emplace_back(point.x_m, point.y_m, point.z_m);
    }
  }
}

void Sampler::finish() {
  // Evenly through the candidates, which stand in order of azimuth.
  sample_.clear();
  const std::size_t wanted = std::min(sample_points_, candidates_.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    sample_.push_back(candidates_[i * candidates_.size() / wanted]);
  }
  // Points lie on surfaces: their number falls with the square of the voxel's edge.
  const float ratio = static_cast<float>(candidates_.size() + 1) / static_cast<float>(sample_points_);
  sample_voxel_m_ = std::clamp(sample_voxel_m_ * std::clamp(std::sqrt(ratio), 0.7F, 1.4F), finest_voxel_m_,
                               kCoarsestVoxelM);
}

void Sampler::thin(RegisteredScan& out) {
  const std::span<const ScanPoint> all(out.points, out.point_count);
  start(out);
  add(all, out);
  finish();
}

}  // namespace isobar
