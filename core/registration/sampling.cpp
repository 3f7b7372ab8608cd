// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/sampling.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace isobar {

namespace {
constexpr float kFarthestM = 500.0F;
constexpr int kBitsPerAxis = 15;  // 45 bits of voxel, 19 of pass
constexpr std::uint64_t kPasses = std::uint64_t{1} << 19U;
constexpr float kFinestVoxelM = 0.05F;
constexpr float kCoarsestVoxelM = 3.0F;
}  // namespace

VoxelFilter::VoxelFilter(std::size_t max_points) : table_(std::bit_ceil(max_points * 2), 0) {}

void VoxelFilter::start(float edge_m) {
  // 15 bits an axis reach 500 m with voxels of 3 cm.
  voxels_per_m_ = 1.0F / std::max(edge_m, 2.0F * kFarthestM / static_cast<float>(1 << kBitsPerAxis));
  used_ = 0;
  if (++pass_ == kPasses) {
    std::fill(table_.begin(), table_.end(), 0);
    pass_ = 1;
  }
}

bool VoxelFilter::first(const Eigen::Vector3f& p) {
  if (!(p.cwiseAbs().maxCoeff() < kFarthestM) || used_ * 2 > table_.size()) {
    return false;
  }
  const Eigen::Array3f scaled = (p.array() + kFarthestM) * voxels_per_m_;
  const std::uint64_t voxel = (static_cast<std::uint64_t>(scaled.x()) << (2U * kBitsPerAxis)) |
                              (static_cast<std::uint64_t>(scaled.y()) << unsigned{kBitsPerAxis}) |
                              static_cast<std::uint64_t>(scaled.z());
  const std::uint64_t entry = (pass_ << (3U * kBitsPerAxis)) | voxel;
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = (voxel * 0x9E3779B97F4A7C15ULL >> 32U) & mask;
  while ((table_[slot] >> (3U * kBitsPerAxis)) == pass_) {
    if (table_[slot] == entry) {
      return false;
    }
    slot = (slot + 1) & mask;
  }
  table_[slot] = entry;
  ++used_;
  return true;
}

Sampler::Sampler(double map_voxel_m, std::size_t sample_points)
    : map_voxel_m_(static_cast<float>(map_voxel_m)),
      sample_points_(sample_points),
      sample_voxel_m_(std::max(4.0F * map_voxel_m_, kFinestVoxelM)),
      filter_(RegisteredScan::kMaxPoints) {
  sample_.reserve(sample_points);
  candidates_.reserve(RegisteredScan::kMaxPoints);
}

void Sampler::thin(RegisteredScan& out) {
  filter_.start(map_voxel_m_);
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < out.point_count; ++i) {
    const ScanPoint& point = out.points[i];
    if (filter_.first({point.x_m, point.y_m, point.z_m})) {
      out.points[kept++] = point;
    }
  }
  out.point_count = kept;

  filter_.start(sample_voxel_m_);
  candidates_.clear();
  for (std::uint32_t i = 0; i < kept; ++i) {
    const Eigen::Vector3f p(out.points[i].x_m, out.points[i].y_m, out.points[i].z_m);
    if (filter_.first(p)) {
      candidates_.push_back(p);
    }
  }
  // Evenly through the candidates, which stand in order of azimuth.
  sample_.clear();
  const std::size_t wanted = std::min(sample_points_, candidates_.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    sample_.push_back(candidates_[i * candidates_.size() / wanted]);
  }
  // Points lie on surfaces: their number falls with the square of the voxel's edge.
  const float ratio = static_cast<float>(candidates_.size() + 1) / static_cast<float>(sample_points_);
  sample_voxel_m_ = std::clamp(sample_voxel_m_ * std::clamp(std::sqrt(ratio), 0.7F, 1.4F),
                               std::max(map_voxel_m_, kFinestVoxelM), kCoarsestVoxelM);
}

}  // namespace isobar
