// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/slab_image.hpp"

#include <algorithm>
#include <cmath>

#include "core/place/place_grid.hpp"

namespace isobar {

namespace {

// The robot stands on the ground or up to this above it: base_link is its lowest point or its centre.
constexpr double kLargestBaseM = 1.2;
constexpr double kSunkM = 0.3;
// The ground below the robot may be unseen, since the lidar is blind around its foot: as far as mark_standing() reaches.
constexpr int kStandingReach = 2 * SlabImage::kStandingCells;
// Width and height of the image are multiples of this, so that the coarse levels end with it.
constexpr int kMultiple = 8;

int rounded_up(int value) { return (value + kMultiple - 1) / kMultiple * kMultiple; }
int rounded_down(int value) { return static_cast<int>(std::floor(double(value) / kMultiple)) * kMultiple; }

}  // namespace

// Voxels of the slab.
struct SlabImage::SlabBand {
  explicit SlabBand(const SlabHeight& height) {
    const double error_m = 3.0 * height.sigma_m;
    base_m = height.z_m;
    ground_low = place_cell(height.z_m - kLargestBaseM - error_m);
    ground_high = place_cell(height.z_m + kSunkM + error_m);
    wall_low = place_cell(height.z_m + static_cast<double>(kLowestLevelM));
    wall_high = place_cell(height.z_m + static_cast<double>(kLowestLevelM + kHeightLevels * kHeightLevelM));
  }
  [[nodiscard]] bool has(const StructureMap::Tile& tile) const {
    return tile.high.z >= std::min(ground_low, wall_low) && tile.low.z <= std::max(ground_high, wall_high);
  }
  [[nodiscard]] bool is_ground(const StructureVoxel& voxel) const {
    return (voxel.kinds & kGroundStructure) != 0 && voxel.z >= ground_low && voxel.z <= ground_high;
  }
  // Level of a wall, 0 for other voxels.
  [[nodiscard]] std::uint16_t wall(const StructureVoxel& voxel) const {
    if ((voxel.kinds & kWallStructure) == 0) return 0;
    return height_bit((static_cast<float>(voxel.z) + 0.5F) * kPlaceCellM - static_cast<float>(base_m));
  }

  double base_m = 0.0;
  int ground_low = 0;
  int ground_high = 0;
  int wall_low = 0;
  int wall_high = 0;
};

bool SlabImage::build(const StructureMap& map, const SlabHeight& height, const SlabWindow& window) {
  width_ = height_ = 0;
  const SlabBand band(height);
  if (!set_extent(map, band, window)) {
    width_ = height_ = 0;
    return false;
  }
  const auto cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  scores_.assign(cells, 0);
  standing_.assign(cells / (std::size_t{kStandingCells} * kStandingCells), 0);
  walls_.assign(cells, 0);
  marked_.clear();
  draw(map, band);
  draw_scores();
  return true;
}

// All ground on which the robot may stand, and the border around it.
bool SlabImage::set_extent(const StructureMap& map, const SlabBand& band, const SlabWindow& window) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (const auto& [key, tile] : map.tiles()) {
    if (!band.has(tile)) continue;
    for (const StructureVoxel& voxel : tile.voxels) {
      if (!band.is_ground(voxel)) continue;
      const Eigen::Vector2d cell(voxel.x, voxel.y);
      low = low.cwiseMin(cell);
      high = high.cwiseMax(cell);
    }
  }
  const Eigen::Array2d per_m = Eigen::Array2d::Constant(1.0 / static_cast<double>(kPlaceCellM));
  const double margin = kStandingReach;
  low = (low.array() - margin).max(window.low.array() * per_m - 1.0).floor();
  high = (high.array() + margin).min(window.high.array() * per_m + 1.0).ceil();
  if (!(low.x() <= high.x() && low.y() <= high.y())) return false;
  const Eigen::Vector2d size = (high - low).array() + 2.0 * kBorder + 2.0 * kMultiple;
  if (size.prod() > static_cast<double>(kMostCells)) return false;
  first_x_ = rounded_down(static_cast<int>(low.x()) - kBorder);
  first_y_ = rounded_down(static_cast<int>(low.y()) - kBorder);
  width_ = rounded_up(static_cast<int>(high.x()) + kBorder + 1 - first_x_);
  height_ = rounded_up(static_cast<int>(high.y()) + kBorder + 1 - first_y_);
  return true;
}

void SlabImage::draw(const StructureMap& map, const SlabBand& band) {
  const std::uint16_t compared = [] {
    unsigned bits = 0;
    for (float z = kWallLowM; z < kWallHighM; z += kHeightLevelM / 2) bits |= height_bit(z);
    return static_cast<std::uint16_t>(bits);
  }();
  for (const auto& [key, tile] : map.tiles()) {
    if (!band.has(tile) || tile.high.x < first_x_ || tile.low.x >= first_x_ + width_ ||
        tile.high.y < first_y_ || tile.low.y >= first_y_ + height_) {
      continue;
    }
    for (const StructureVoxel& voxel : tile.voxels) {
      const int column = voxel.x - first_x_;
      const int row = voxel.y - first_y_;
      if (column < 1 || row < 1 || column >= width_ - 1 || row >= height_ - 1) continue;
      const std::size_t at = index(column, row);
      if (band.is_ground(voxel)) mark_standing(column, row);
      const std::uint16_t level = band.wall(voxel);
      if (level == 0) continue;
      const bool first = (walls_[at] & compared) == 0 && (level & compared) != 0;
      if (first) marked_.push_back(static_cast<std::uint32_t>(at));
      walls_[at] = static_cast<std::uint16_t>(walls_[at] | level);
    }
  }
}

// Cells beside a wall count less: the pose of a hypothesis is off by half a cell.
void SlabImage::draw_scores() {
  const auto raise = [this](std::size_t at, std::uint8_t score) {
    scores_[at] = std::max(scores_[at], score);
  };
  const auto row = static_cast<std::size_t>(width_);
  for (const std::size_t at : marked_) {
    scores_[at] = kFullScore;
    for (const std::size_t beside : {at - 1, at + 1, at - row, at + row}) raise(beside, kBesideScore);
    for (const std::size_t corner : {at - row - 1, at - row + 1, at + row - 1, at + row + 1}) {
      raise(corner, kDiagonalScore);
    }
  }
}

void SlabImage::mark_standing(int column, int row) {
  const int blocks = width_ / kStandingCells;
  const int last_row = height_ / kStandingCells - 1;
  const int block = column / kStandingCells;
  const int block_row = row / kStandingCells;
  for (int y = std::max(block_row - 1, 0); y <= std::min(block_row + 1, last_row); ++y) {
    for (int x = std::max(block - 1, 0); x <= std::min(block + 1, blocks - 1); ++x) {
      standing_[static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks) +
                static_cast<std::size_t>(x)] = 1;
    }
  }
}

}  // namespace isobar
