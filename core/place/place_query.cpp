// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/place_query.hpp"

#include <algorithm>
#include <cmath>

#include "core/place/place_grid.hpp"

namespace isobar {

namespace {

constexpr int kHalfCells = static_cast<int>(kViewRangeM / kPlaceCellM) + 1;
constexpr int kGridCells = 2 * kHalfCells;
// A column with points over this span of heights is a wall; ground and ceilings have less, noise of the range included.
constexpr float kWallSpanM = 0.3F;
// Rays count as free space from here, and up to this before their end.
constexpr float kRayBeginM = 0.6F;
constexpr float kRayMarginM = 0.5F;
// Free cells within this many cells of a point are not judged: the pose of a hypothesis is off by centimetres, and so are
// walls of the map.
constexpr int kBlockedCells = 2;
constexpr float kSampleVoxelM = 0.3F;
constexpr float kGroundRangeM = 6.0F;
// States of a column.
constexpr std::uint8_t kHasPoint = 1;
constexpr std::uint8_t kBlocked = 2;
constexpr std::uint8_t kWall = 4;

int grid_cell(float coordinate_m) {
  return static_cast<int>(std::floor(coordinate_m / kPlaceCellM)) + kHalfCells;
}
float middle_of(int cell) { return (static_cast<float>(cell - kHalfCells) + 0.5F) * kPlaceCellM; }
std::size_t grid_index(int column, int row) {
  return static_cast<std::size_t>(row) * kGridCells + static_cast<std::size_t>(column);
}
std::size_t grid_index(const Eigen::Vector3f& p) { return grid_index(grid_cell(p.x()), grid_cell(p.y())); }

bool compared(const Eigen::Vector3f& p) { return p.z() >= kWallLowM && p.z() <= kWallHighM; }

// Keeps at most `most` elements, evenly over their order. Neighbours in it are neighbours in space, mostly.
template <typename T>
void thin(std::vector<T>& values, std::size_t most) {
  if (values.size() <= most) return;
  for (std::size_t i = 0; i < most; ++i) values[i] = values[i * values.size() / most];
  values.resize(most);
}

std::uint64_t sample_voxel(const Eigen::Vector3f& p) {
  const auto cell = [](float c) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(c / kSampleVoxelM)) + 4096) &
           0x1FFFU;
  };
  return cell(p.x()) << 26U | cell(p.y()) << 13U | cell(p.z());
}

}  // namespace

PlaceQuery::PlaceQuery() : grid_(static_cast<std::size_t>(kGridCells) * kGridCells) { clear(); }

void PlaceQuery::clear() {
  points_.clear();
  scans_.clear();
  ray_ends_.clear();
  columns_.clear();
  wall_points_.clear();
  other_points_.clear();
  free_cells_.clear();
  sample_.clear();
}

void PlaceQuery::clear_grid() { std::fill(grid_.begin(), grid_.end(), Column{1e9F, -1e9F, 0, 0}); }

void PlaceQuery::add(std::span<const Eigen::Vector3f> p_level, const Eigen::Vector3f& p_level_lidar,
                     bool has_rays) {
  p_level_lidar_ = p_level_lidar;
  const std::size_t before = points_.size();
  for (const Eigen::Vector3f& p : p_level) {
    if (p.allFinite() && p.head<2>().squaredNorm() < kViewRangeM * kViewRangeM && std::abs(p.z()) < 100.0F) {
      points_.push_back(p);
    }
  }
  if (!has_rays) return;
  scans_.push_back({before, points_.size(), p_level_lidar});
  const std::size_t step = std::max<std::size_t>((points_.size() - before) / kMostRays, 1);
  for (std::size_t i = before; i < points_.size(); i += step) ray_ends_.push_back(points_[i]);
}

std::vector<PlaceQuery::Scan> PlaceQuery::scans() const {
  std::vector<Scan> scans;
  for (const ScanRange& range : scans_) {
    scans.push_back({std::span(points_).subspan(range.begin, range.end - range.begin), range.p_level_lidar});
  }
  return scans;
}

void PlaceQuery::finish() {
  clear_grid();
  thin(ray_ends_, kMostRays);
  for (const Eigen::Vector3f& end : ray_ends_) mark_ray(end);
  mark_points();
  block_free_beside_points();
  collect_columns();
  collect_wall_points();
  collect_free_cells();
  collect_sample();
  find_ground();
}

void PlaceQuery::mark_points() {
  for (const Eigen::Vector3f& p : points_) {
    if (!compared(p)) continue;
    Column& column = grid_[grid_index(p)];
    column.state |= kHasPoint;
    column.low_m = std::min(column.low_m, p.z());
    column.high_m = std::max(column.high_m, p.z());
    if (column.high_m - column.low_m >= kWallSpanM) column.state |= kWall;
  }
}

void PlaceQuery::mark_ray(const Eigen::Vector3f& end) {
  const Eigen::Vector3f ray = end - p_level_lidar_;
  const float range_m = ray.norm();
  if (range_m < kRayBeginM + kRayMarginM) return;
  const Eigen::Vector3f unit = ray / range_m;
  for (float along_m = kRayBeginM; along_m < range_m - kRayMarginM; along_m += kPlaceCellM) {
    const Eigen::Vector3f p = p_level_lidar_ + along_m * unit;
    Column& column = grid_[grid_index(p)];
    column.free = static_cast<std::uint16_t>(column.free | height_bit(p.z()));
  }
}

void PlaceQuery::block_free_beside_points() {
  for (int row = kBlockedCells; row < kGridCells - kBlockedCells; ++row) {
    for (int column = kBlockedCells; column < kGridCells - kBlockedCells; ++column) {
      if ((grid_[grid_index(column, row)].state & kHasPoint) == 0) continue;
      for (int y = row - kBlockedCells; y <= row + kBlockedCells; ++y) {
        for (int x = column - kBlockedCells; x <= column + kBlockedCells; ++x) {
          grid_[grid_index(x, y)].state |= kBlocked;
        }
      }
    }
  }
}

void PlaceQuery::collect_columns() {
  for (int row = 0; row < kGridCells; ++row) {
    for (int column = 0; column < kGridCells; ++column) {
      if ((grid_[grid_index(column, row)].state & kWall) == 0) continue;
      const Eigen::Vector2f p(middle_of(column), middle_of(row));
      if (p.squaredNorm() < kPlaceRangeM * kPlaceRangeM) columns_.push_back(p);
    }
  }
  thin(columns_, kMostColumns);
}

void PlaceQuery::collect_wall_points() {
  for (const Eigen::Vector3f& p : points_) {
    if (compared(p) && (grid_[grid_index(p)].state & kWall) != 0) wall_points_.push_back(p);
  }
  // One a voxel, so that near walls do not outweigh the others.
  std::stable_sort(wall_points_.begin(), wall_points_.end(),
                   [](const auto& a, const auto& b) { return sample_voxel(a) < sample_voxel(b); });
  const auto same = [](const auto& a, const auto& b) { return sample_voxel(a) == sample_voxel(b); };
  wall_points_.erase(std::unique(wall_points_.begin(), wall_points_.end(), same), wall_points_.end());
  thin(wall_points_, kMostWallPoints);
}

void PlaceQuery::collect_free_cells() {
  for (int row = 0; row < kGridCells; ++row) {
    for (int column = 0; column < kGridCells; ++column) {
      const Column& cell = grid_[grid_index(column, row)];
      if (cell.free == 0 || (cell.state & kBlocked) != 0) continue;
      free_cells_.push_back({{middle_of(column), middle_of(row)}, cell.free});
    }
  }
  thin(free_cells_, kMostFreeCells);
}

void PlaceQuery::collect_sample() {
  sample_ = points_;
  std::stable_sort(sample_.begin(), sample_.end(),
                   [](const auto& a, const auto& b) { return sample_voxel(a) < sample_voxel(b); });
  const auto same = [](const auto& a, const auto& b) { return sample_voxel(a) == sample_voxel(b); };
  sample_.erase(std::unique(sample_.begin(), sample_.end(), same), sample_.end());
  thin(sample_, kMostSamples);
  for (const Eigen::Vector3f& p : sample_) {
    if ((grid_[grid_index(p)].state & kWall) == 0) other_points_.push_back(p);
  }
}

// The lowest tenth of what is near, below the lidar.
void PlaceQuery::find_ground() {
  std::vector<float> heights_m;
  for (const Eigen::Vector3f& p : sample_) {
    if (p.head<2>().norm() < kGroundRangeM && p.z() < p_level_lidar_.z() - 0.1F) heights_m.push_back(p.z());
  }
  ground_z_m_ = 0.0F;
  if (heights_m.empty()) return;
  const auto lowest = heights_m.begin() + static_cast<std::ptrdiff_t>(heights_m.size() / 10);
  std::nth_element(heights_m.begin(), lowest, heights_m.end());
  ground_z_m_ = *lowest;
}

}  // namespace isobar
