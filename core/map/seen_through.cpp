// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/seen_through.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/map/scan_decimation.hpp"

namespace isobar {

namespace {

// Interval over which scans share the test of all blocks [s]: the rays of scans so close together pass
// through nearly the same cells.
constexpr double kTestIntervalS = 0.3;

}  // namespace

SeenThrough::SeenThrough(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar)
    : cell_m_(static_cast<float>(config.cell_m)),
      reach_m_(static_cast<float>(config.see_through_range_m)),
      margin_m_(static_cast<float>(config.see_through_margin_m)),
      limit_(static_cast<std::uint8_t>(config.see_through_limit)),
      T_lidar_base_(T_base_lidar.inverse()),
      free_space_(cell_m_) {}

void SeenThrough::set_scan(const RegisteredScan& scan, double elapsed_s) {
  ++scan_count_;
  decimation_ = decimation_factor(elapsed_s, kTestIntervalS);
  free_space_.set_scan(scan, T_lidar_base_);
  p_map_base_ = scan.pose.T_map_base.translation();
  frame_ = LocalFrame(p_map_base_, cell_m_);
  const Eigen::Isometry3d T_lidar_map = T_lidar_base_ * scan.pose.T_map_base.inverse();
  T_lidar_local_ = (T_lidar_map * Eigen::Translation3d(frame_.origin_map)).cast<float>();
  p_local_lidar_ = T_lidar_local_.inverse().translation();
}

bool SeenThrough::reaches(const TileKey& key) const {
  return (centre_of(key, cell_m_) - p_map_base_).norm() <= static_cast<double>(reach_m_) + tile_m(cell_m_);
}

bool SeenThrough::count(const TileKey& key, std::size_t index, MapBlock& block) const {
  if ((key.hash() + index + scan_count_) % decimation_ != 0) {
    return false;
  }
  const Eigen::Vector3f centre_local = block_centre_local(frame_, first_cell(key, index));
  const float block_reach_m = reach_m_ + 0.87F * kBlockCells * cell_m_;  // sqrt(3) / 2: half the diagonal
  return (centre_local - p_local_lidar_).norm() <= block_reach_m && count_cells(centre_local, block);
}

bool SeenThrough::count_cells(const Eigen::Vector3f& centre_local, MapBlock& block) const {
  const Eigen::Vector3f first_centre = centre_local.array() + 0.5F * (1 - kBlockCells) * cell_m_;
  const std::vector<MapCell>& cells = block.cells();
  FreeSpace::Points p_lidar;
  bool any = false;
  for (std::size_t first = 0; first < cells.size(); first += FreeSpace::Points::kMost) {
    const std::size_t count = std::min(FreeSpace::Points::kMost, cells.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const MapCell& cell = cells[first + i];
      const CellIndex offset = offset_of(cell.slot % kPlacesPerBlock);
      const Eigen::Vector3f p_local =
          first_centre + offset.cast<float>() * cell_m_ + cell.moments.mean_m(cell_m_);
      p_lidar.set(i, T_lidar_local_ * p_local);
    }
    any = count_batch(p_lidar, first, count, block) || any;
  }
  return any;
}

// Tests cells `first` … `first + count - 1` of the block; `p_lidar`: the means of their points.
bool SeenThrough::count_batch(const FreeSpace::Points& p_lidar, std::size_t first, std::size_t count,
                              MapBlock& block) const {
  constexpr std::uint8_t kSaturated = std::numeric_limits<std::uint8_t>::max();
  FreeSpace::Ranges min_range_m;
  free_space_.min_ranges(p_lidar, count, min_range_m);
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    MapCell& cell = block.cells()[first + i];
    const Eigen::Vector3f p = p_lidar.at(i);
    // Early exit before the plane is looked up: most rays end too close behind the cell for any normal.
    const float limit_m = std::abs(min_range_m[i]) - margin_m_;
    if (cell.seen_through == kSaturated || !(limit_m > 0.0F) || p.squaredNorm() > limit_m * limit_m) {
      continue;
    }
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    if (const PackedPlane* plane = block.plane_at(cell.slot)) {
      normal = T_lidar_local_.linear() * plane->unit_normal();
    }
    if (FreeSpace::passes_through(p, normal, min_range_m[i], margin_m_)) {
      any = ++cell.seen_through > limit_ || any;
    }
  }
  return any;
}

}  // namespace isobar
