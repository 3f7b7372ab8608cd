// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/structure_map.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/place/place_grid.hpp"

namespace isobar {

namespace {

// Vertical component of the unit normal of what counts as a wall, and of ground: up to 30 degrees of slope.
constexpr float kWallNormalZ = 0.4F;
constexpr float kGroundNormalZ = 0.85F;
constexpr double kReachM = 6000.0;

std::uint8_t kind_of(const Eigen::Vector3f& normal) {
  if (normal.squaredNorm() < 0.5F) return kOtherStructure;
  if (std::abs(normal.z()) <= kWallNormalZ) return kWallStructure;
  return normal.z() >= kGroundNormalZ ? kGroundStructure : 0;
}

auto place_of_voxel(const StructureVoxel& voxel) { return std::tie(voxel.x, voxel.y, voxel.z); }

// Sorts, and unites the kinds of equal voxels.
void unite(std::vector<StructureVoxel>& voxels) {
  std::sort(voxels.begin(), voxels.end(), [](const StructureVoxel& a, const StructureVoxel& b) {
    return place_of_voxel(a) < place_of_voxel(b);
  });
  std::size_t kept = 0;
  for (const StructureVoxel& voxel : voxels) {
    if (kept > 0 && place_of_voxel(voxels[kept - 1]) == place_of_voxel(voxel)) {
      voxels[kept - 1].kinds |= voxel.kinds;
    } else {
      voxels[kept++] = voxel;
    }
  }
  voxels.resize(kept);
  voxels.shrink_to_fit();
}

}  // namespace

void StructureMap::set_tile(const TileKey& key, std::span<const MapPoint> points) {
  std::vector<StructureVoxel> voxels;
  voxels.reserve(points.size());
  for (const MapPoint& point : points) {
    const std::uint8_t kinds = kind_of(point.normal_map);
    const Eigen::Vector3d& p = point.p_map;
    if (kinds == 0 || !p.allFinite() || std::abs(p.z()) > kReachM ||
        p.head<2>().cwiseAbs().maxCoeff() > 1e7) {
      continue;
    }
    voxels.push_back(
        {place_cell(p.x()), place_cell(p.y()), static_cast<std::int16_t>(place_cell(p.z())), kinds});
  }
  if (voxels.empty()) {
    tiles_.erase(key);
    return;
  }
  unite(voxels);
  Tile tile{{}, voxels.front(), voxels.front()};
  for (const StructureVoxel& voxel : voxels) {
    tile.low = {std::min(tile.low.x, voxel.x), std::min(tile.low.y, voxel.y), std::min(tile.low.z, voxel.z)};
    tile.high = {std::max(tile.high.x, voxel.x), std::max(tile.high.y, voxel.y),
                 std::max(tile.high.z, voxel.z)};
  }
  tile.voxels = std::move(voxels);
  tiles_.insert_or_assign(key, std::move(tile));
}

std::size_t StructureMap::voxel_count() const {
  std::size_t count = 0;
  for (const auto& [key, tile] : tiles_) count += tile.voxels.size();
  return count;
}

}  // namespace isobar
