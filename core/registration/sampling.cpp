// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {
// Bounds of the adaptive voxel. Finer than 5 cm resolves the lidar's noise, coarser than 3 m misses objects.
constexpr float kFinestVoxelM = 0.05F;
constexpr float kCoarsestVoxelM = 3.0F;
// Step of the order without pattern: a prime beyond the largest scan.
constexpr std::size_t kStep = 1'000'003;
}  // namespace

Sampler::Sampler(double map_voxel_m, std::size_t sample_points)
    : map_grid_(static_cast<float>(map_voxel_m)),
      beside_m_(static_cast<float>(map_voxel_m)),
      sample_points_(sample_points),
      finest_voxel_m_(std::max(static_cast<float>(map_voxel_m), kFinestVoxelM)),
      sample_voxel_m_(std::max(4.0F * static_cast<float>(map_voxel_m), kFinestVoxelM)),
      sample_grid_(sample_voxel_m_),
      map_filter_(RegisteredScan::kMaxPoints),
      sample_filter_(RegisteredScan::kMaxPoints),
      deciders_(RegisteredScan::kMaxPoints) {
  sample_.reserve(sample_points);
  candidates_.reserve(RegisteredScan::kMaxPoints);
}

void Sampler::start(RegisteredScan& out) {
  out.point_count = 0;
  candidates_.clear();
  map_filter_.start();
  sample_filter_.start();
  sample_grid_ = VoxelGrid(sample_voxel_m_);
  ends_.fill({});
  rings_ = 0;
}

void Sampler::add(std::span<const ScanPoint> points, RegisteredScan& out) {
  while (!points.empty()) {
    const std::size_t part = std::min(points.size(), kPart);
    add_part(points.first(part), out);
    points = points.subspan(part);
  }
}

void Sampler::add_part(std::span<const ScanPoint> points, RegisteredScan& out) {
  // A copy, because kept points go to out.points, in which the part may lie.
  std::copy(points.begin(), points.end(), window_.begin() + kRings);
  // Near the sensor one laser hits a voxel many times in a row: this rejects most points before the hash
  // table. Branch-free: the outcome is unpredictable and && would mispredict.
  std::size_t arrivals = 0;
  const auto part_end = static_cast<std::uint32_t>(kRings + points.size());
  for (std::uint32_t at = kRings; at < part_end; ++at) {
    RingEnd& end = ends_[window_[at].ring];
    arrivals_[arrivals] = {end.voxel, end.at, at};
    arrivals += end.arrives;
    const std::uint64_t voxel = map_grid_.voxel_of(window_[at]);
    end = {voxel, at, std::uint32_t{voxel != end.voxel} & std::uint32_t{voxel != VoxelGrid::kNowhere}};
    rings_ = std::max(rings_, std::size_t{window_[at].ring} + 1);
  }
  for (const Arrival& arrival : std::span(arrivals_).first(arrivals)) keep(arrival, out);
  for (std::uint32_t ring = 0; ring < rings_; ++ring) {
    window_[ring] = window_[ends_[ring].at];
    ends_[ring].at = ring;
  }
}

bool Sampler::beside(const ScanPoint& a, const ScanPoint& b) const {
  const float x_m = a.x_m - b.x_m;
  const float y_m = a.y_m - b.y_m;
  const float z_m = a.z_m - b.z_m;
  return x_m * x_m + y_m * y_m + z_m * z_m < beside_m_ * beside_m_;
}

void Sampler::keep(const Arrival& arrival, RegisteredScan& out) {
  if (!map_filter_.first(arrival.voxel)) return;
  const ScanPoint& decider = window_[arrival.at];
  const ScanPoint& next = window_[arrival.next];
  deciders_[out.point_count] = decider;
  out.points[out.point_count++] = beside(decider, next) ? next : decider;
}

// One point for each voxel of the coarser grid, in an order without pattern: in the order of firing it would be the lowest
// laser's or the left edge's, while the map holds them all.
void Sampler::choose_candidates(const RegisteredScan& out) {
  const std::size_t count = out.point_count;
  if (count == 0) return;
  const std::size_t step = kStep % count;  // prime and larger than any count: every index once
  std::size_t index = 0;
  for (std::size_t i = 0; i < count; ++i) {
    index += step;
    if (index >= count) index -= count;
    if (sample_filter_.first(sample_grid_.voxel_of(deciders_[index]))) {
      const ScanPoint& point = out.points[index];
      candidates_.emplace_back(point.x_m, point.y_m, point.z_m);
    }
  }
}

void Sampler::finish(RegisteredScan& out) {
  for (std::size_t ring = 0; ring < rings_; ++ring) {
    const RingEnd& end = ends_[ring];
    if (end.arrives != 0) keep({end.voxel, end.at, end.at}, out);
  }
  choose_candidates(out);
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
