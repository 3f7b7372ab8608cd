// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {
// Bounds of the adaptive voxel. Finer than 5 cm resolves the lidar's noise, coarser than 3 m misses objects.
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
  while (!points.empty()) {
    const std::size_t part = std::min(points.size(), kPart);
    add_part(points.first(part), out);
    points = points.subspan(part);
  }
}

void Sampler::add_part(std::span<const ScanPoint> points, RegisteredScan& out) {
  // Near the sensor one laser hits a voxel many times in a row: this rejects most points before the hash
  // table. Branch-free: the outcome is unpredictable and && would mispredict.
  std::size_t arrivals = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t voxel = map_grid_.voxel_of(points[i]);
    std::uint64_t& last = last_voxel_[points[i].ring];
    arrivals_[arrivals] = {voxel, i};
    arrivals += std::size_t{voxel != last} & std::size_t{voxel != VoxelGrid::kNowhere};
    last = voxel;
  }
  for (const Arrival& arrival : std::span(arrivals_).first(arrivals)) {
    if (!map_filter_.first(arrival.voxel)) {
      continue;
    }
    const ScanPoint point = points[arrival.index];
    out.points[out.point_count++] = point;
    if (sample_filter_.first(sample_grid_.voxel_of(point))) {
      candidates_.emplace_back(point.x_m, point.y_m, point.z_m);
    }
  }
}

void Sampler::finish() {
  // Every n-th candidate: they are in order of azimuth.
  sample_.clear();
  const std::size_t wanted = std::min(sample_points_, candidates_.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    sample_.push_back(candidates_[i * candidates_.size() / wanted]);
  }
  // Edge for the next scan. Points lie on surfaces, so their number is inversely proportional to its square.
  const float ratio = static_cast<float>(candidates_.size() + 1) / static_cast<float>(sample_points_);
  sample_voxel_m_ = std::clamp(sample_voxel_m_ * std::clamp(std::sqrt(ratio), 0.7F, 1.4F), finest_voxel_m_,
                               kCoarsestVoxelM);
}

}  // namespace isobar
