// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/slab_heights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "core/place/place_grid.hpp"

namespace isobar {

namespace {

// Largest error of one slab, 3 sigma.
constexpr double kOneSlabM = 1.0;
constexpr double kApartM = 0.6;
// Error of the height of a level.
constexpr double kLevelSigmaM = 0.15;
// Ground of less than this is no floor [cells].
constexpr std::size_t kLeastCells = 100;

struct GroundLevel {
  double z_m;
  std::size_t cells;
};

std::vector<GroundLevel> levels_within(const StructureMap& map, double low_m, double high_m) {
  const int low = place_cell(low_m);
  const int high = place_cell(high_m);
  std::map<int, std::size_t> cells;
  for (const auto& [key, tile] : map.tiles()) {
    if (tile.high.z < low || tile.low.z > high) continue;
    for (const StructureVoxel& voxel : tile.voxels) {
      if ((voxel.kinds & kGroundStructure) != 0 && voxel.z >= low && voxel.z <= high) ++cells[voxel.z];
    }
  }
  std::vector<GroundLevel> levels;
  for (const auto& [z, count] : cells) {
    if (count >= kLeastCells) levels.push_back({(z + 0.5) * static_cast<double>(kPlaceCellM), count});
  }
  return levels;
}

}  // namespace

std::vector<SlabHeight> slab_heights(const StructureMap& map, const SlabHeight& height,
                                     double base_above_ground_m) {
  const double error_m = 3.0 * height.sigma_m;
  if (error_m <= kOneSlabM) return {height};
  const double ground_m = height.z_m - base_above_ground_m;
  std::vector<GroundLevel> levels = levels_within(map, ground_m - error_m, ground_m + error_m);
  std::stable_sort(levels.begin(), levels.end(),
                   [](const GroundLevel& a, const GroundLevel& b) { return a.cells > b.cells; });
  std::vector<SlabHeight> heights;
  for (const GroundLevel& level : levels) {
    const double z_m = level.z_m + base_above_ground_m;
    const bool known = std::any_of(heights.begin(), heights.end(), [&](const SlabHeight& other) {
      return std::abs(other.z_m - z_m) < kApartM;
    });
    if (!known && heights.size() < kMostSlabs) heights.push_back({z_m, kLevelSigmaM});
  }
  return heights;
}

}  // namespace isobar
