// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/errors.hpp"
#include "core/map/grid.hpp"

namespace isobar {

namespace {

constexpr int kMarginCells = 4;       // of unknown around the known part
constexpr float kUprightM = 0.5F;     // horizontal part of a normal above which a surface is drawn as a line
constexpr double kRayStartsM = 1.0;   // between places of the path from which rays are cast
constexpr std::int8_t kWeak = 50;     // an obstacle that counts if it is connected to a confirmed one
constexpr std::int8_t kBlurred = 40;  // one without a plane, in many places of its cell of the map
constexpr int kBlurredThirds = 8;     // of 27; a post has 3 to 6
constexpr double kTrailWallM = 0.6;   // MapConfig::see_through_margin_m and a cell of the map
constexpr int kTrailGroundCells = 3;  // around a cell
constexpr int kTrailGroundSeen = 5;   // of these 49
constexpr int kSpeckNeighbours = 6;   // free ones of 8 that make an unknown cell free

bool is_observed(const MapPoint& point, int least) {
  return point.observations == 0 || point.observations >= least;
}

/// Empty grid over the columns of the ground.
OccupancyGrid grid_over(const FloorGround& ground, const GridConfig& config) {
  const double column_m = GroundColumns::kColumnM;
  OccupancyGrid grid;
  grid.resolution_m = config.resolution_m;
  const Eigen::Array2d low = Eigen::Array2d(ground.low().x, ground.low().y) * column_m;
  const Eigen::Array2d high = Eigen::Array2d(ground.high().x, ground.high().y) * column_m;
  const Eigen::Array2d first = (low / config.resolution_m).floor();
  const Eigen::Array2d count = (high / config.resolution_m).ceil() - first;
  if (count.prod() > config.cells_at_most) {
    throw DataError("the floor extends over " + std::to_string(std::lround(high.x() - low.x())) + " x " +
                    std::to_string(std::lround(high.y() - low.y())) + " m: a grid has at most " +
                    std::to_string(std::lround(config.cells_at_most)) + " cells, so larger cells are needed");
  }
  grid.origin_m = first * config.resolution_m;
  grid.width = static_cast<int>(count.x());
  grid.height = static_cast<int>(count.y());
  grid.cells.assign(static_cast<std::size_t>(count.prod()), kCellUnknown);
  return grid;
}

}  // namespace

FloorGrid::FloorGrid(const GroundColumns& ground, const Floors& floors, const Floor& floor,
                     std::span<const Eigen::Vector3d> path, const GridConfig& config)
    : config_(config),
      ground_(ground, floors, floor, path),
      grid_(grid_over(ground_, config)),
      cell_ground_(grid_.cells.size(), CellGround::kUnseen) {
  grid_.height_m = floor.height_m;
}

void FloorGrid::add(std::span<const MapPoint> points) {
  for (const MapPoint& point : points) add(point);
}

void FloorGrid::add(const MapPoint& point) {
  const Eigen::Vector2d p_cells = (point.p_map.head<2>() - grid_.origin_m) / grid_.resolution_m;
  if (!(p_cells.minCoeff() >= 0.0 && p_cells.x() < grid_.width && p_cells.y() < grid_.height)) return;
  const ColumnIndex column = GroundColumns::column_of(point.p_map);
  float ground_m = 0.0F;
  if (!ground_.height_near(column, ground_m)) return;
  const double above_m = point.p_map.z() - static_cast<double>(ground_m);
  if (above_m < -config_.lowest_obstacle_m || above_m > config_.robot_height_m) return;
  const double lowest_m = ground_.is_driven(column) ? config_.driven_obstacle_m : config_.lowest_obstacle_m;
  if (above_m > lowest_m) {
    draw_obstacle(point, p_cells);
  } else if (GroundColumns::is_upward(point) && ground_.kind(column) == FloorGround::Kind::kGround) {
    draw_ground(p_cells);
  }
}

void FloorGrid::mark(const Eigen::Vector2d& p_cells, std::int8_t value) {
  const int x = floor_int(p_cells.x());
  const int y = floor_int(p_cells.y());
  if (!grid_.contains(x, y)) return;
  std::int8_t& cell = grid_.cells[grid_.index(x, y)];
  cell = std::max(cell, value);
  if (value == kCellFree) cell_ground_[grid_.index(x, y)] = CellGround::kSeen;
}

void FloorGrid::draw_ground(const Eigen::Vector2d& p_cells) {
  const double half = 0.5 * config_.surface_m / config_.resolution_m;
  for (const double dy : {-half, 0.0, half}) {
    for (const double dx : {-half, 0.0, half}) mark(p_cells + Eigen::Vector2d(dx, dy), kCellFree);
  }
}

// A wall's patch is a line in plan, a table's an area; a point without a normal is one cell. Most of what has no plane
// and few observations is what people leave who walk beside the robot: no ray has passed there again.
void FloorGrid::draw_obstacle(const MapPoint& point, const Eigen::Vector2d& p_cells) {
  const Eigen::Vector2f normal = point.normal_map.head<2>();
  const double half = 0.5 * config_.surface_m / config_.resolution_m;
  const int steps = static_cast<int>(std::ceil(2.0 * half));  // of at most one cell
  const float length = normal.norm();
  if (point.normal_map.isZero()) {
    if (!is_observed(point, config_.confirmed_observations)) return;
    mark(p_cells, point.filled >= kBlurredThirds ? kBlurred : kCellOccupied);
    return;
  }
  const std::int8_t value = is_observed(point, config_.wall_observations) ? kCellOccupied : kWeak;
  const bool is_upright = length > kUprightM;
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  if (is_upright) along = Eigen::Vector2f(-normal.y() / length, normal.x() / length).cast<double>();
  const int rows = is_upright ? 0 : steps;
  for (int j = 0; j <= rows; ++j) {
    const double across = rows == 0 ? 0.0 : half * (2.0 * j / rows - 1.0);
    for (int i = 0; i <= steps; ++i) {
      const double way = half * (2.0 * i / steps - 1.0);
      mark(p_cells + way * along + Eigen::Vector2d(0.0, across), value);
    }
  }
}

ColumnIndex FloorGrid::column_at(int x, int y) const {
  const Eigen::Vector2d p_map =
      grid_.origin_m + (Eigen::Vector2d(x, y).array() + 0.5).matrix() * grid_.resolution_m;
  return GroundColumns::column_of({p_map.x(), p_map.y(), 0.0});
}

void FloorGrid::block_ways_out() {
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      const FloorGround::Kind kind = ground_.kind(column_at(x, y));
      const std::size_t at = grid_.index(x, y);
      if (kind == FloorGround::Kind::kBeyond || kind == FloorGround::Kind::kDrop) {
        cell_ground_[at] = CellGround::kBlocked;
      } else if (kind == FloorGround::Kind::kGround) {
        cell_ground_[at] = CellGround::kSeen;
      }
    }
  }
}

void FloorGrid::clear_path() {
  const int radius = static_cast<int>(std::floor(config_.path_radius_m / grid_.resolution_m));
  for (const Eigen::Vector3d& p_map : ground_.path()) {
    const Eigen::Vector2d centre = (p_map.head<2>() - grid_.origin_m) / grid_.resolution_m;
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        if (dx * dx + dy * dy > radius * radius) continue;
        mark(centre + Eigen::Vector2d(dx, dy), kCellFree);
      }
    }
  }
}

void FloorGrid::cast_rays() {
  FreeRays rays(grid_, cell_ground_, config_.ray_m, config_.most_unseen_ground_m);
  const Eigen::Vector3d* last = nullptr;
  for (const Eigen::Vector3d& p_map : ground_.path()) {
    if (last != nullptr && (p_map - *last).norm() < kRayStartsM) continue;
    rays.cast_from(p_map.head<2>());
    last = &p_map;
  }
}

// Single cells that neither a patch nor a ray has met.
void FloorGrid::fill_specks() {
  const std::vector<std::int8_t> before = grid_.cells;
  const auto width = static_cast<std::ptrdiff_t>(grid_.width);
  for (int y = 1; y + 1 < grid_.height; ++y) {
    for (int x = 1; x + 1 < grid_.width; ++x) {
      const auto at = static_cast<std::ptrdiff_t>(grid_.index(x, y));
      if (before[static_cast<std::size_t>(at)] != kCellUnknown ||
          cell_ground_[static_cast<std::size_t>(at)] == CellGround::kBlocked) {
        continue;
      }
      int free = 0;
      for (const std::ptrdiff_t to : {-width - 1, -width, -width + 1, std::ptrdiff_t{-1}, std::ptrdiff_t{1},
                                      width - 1, width, width + 1}) {
        free += before[static_cast<std::size_t>(at + to)] == kCellFree ? 1 : 0;
      }
      if (free >= kSpeckNeighbours) grid_.cells[static_cast<std::size_t>(at)] = kCellFree;
    }
  }
}

int FloorGrid::count_around(int x, int y, int reach,
                            const std::function<bool(std::size_t)>& is_counted) const {
  int count = 0;
  for (int to_y = std::max(y - reach, 0); to_y <= std::min(y + reach, grid_.height - 1); ++to_y) {
    for (int to_x = std::max(x - reach, 0); to_x <= std::min(x + reach, grid_.width - 1); ++to_x) {
      count += is_counted(grid_.index(to_x, to_y)) ? 1 : 0;
    }
  }
  return count;
}

// The map clears what people leave once rays end well behind it. Before a wall that is nearer they do not, and a trail of
// what has no plane stays, with the ground below it seen, and apart from the wall.
void FloorGrid::settle_blurred() {
  const int wall_reach = static_cast<int>(kTrailWallM / grid_.resolution_m);
  const auto is_plane = [&](std::size_t at) {
    return grid_.cells[at] == kWeak || grid_.cells[at] == kCellOccupied;
  };
  const auto is_seen = [&](std::size_t at) { return cell_ground_[at] == CellGround::kSeen; };
  std::vector<std::size_t> moved;
  std::vector<std::size_t> stays;
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      if (grid_.cells[grid_.index(x, y)] != kBlurred) continue;
      const bool has_moved = count_around(x, y, 1, is_plane) == 0 &&
                             count_around(x, y, kTrailGroundCells, is_seen) >= kTrailGroundSeen &&
                             count_around(x, y, wall_reach, is_plane) > 0;
      (has_moved ? moved : stays).push_back(grid_.index(x, y));
    }
  }
  for (const std::size_t at : moved) grid_.cells[at] = is_seen(at) ? kCellFree : kCellUnknown;
  for (const std::size_t at : stays) grid_.cells[at] = kCellOccupied;
}

// Hysteresis: weak cells that are connected with an occupied one become occupied, the others what the ground says.
void FloorGrid::confirm() {
  std::vector<std::size_t> front;
  for (std::size_t at = 0; at < grid_.cells.size(); ++at) {
    if (grid_.cells[at] == kCellOccupied) front.push_back(at);
  }
  const auto width = static_cast<std::size_t>(grid_.width);
  while (!front.empty()) {
    const std::size_t from = front.back();
    front.pop_back();
    const int x = static_cast<int>(from % width);
    const int y = static_cast<int>(from / width);
    for (int i = 0; i < 9; ++i) {
      const int to_x = x + i % 3 - 1;
      const int to_y = y + i / 3 - 1;
      if (!grid_.contains(to_x, to_y) || grid_.cells[grid_.index(to_x, to_y)] != kWeak) continue;
      grid_.cells[grid_.index(to_x, to_y)] = kCellOccupied;
      front.push_back(grid_.index(to_x, to_y));
    }
  }
  for (std::size_t at = 0; at < grid_.cells.size(); ++at) {
    if (grid_.cells[at] != kWeak) continue;
    grid_.cells[at] = cell_ground_[at] == CellGround::kSeen ? kCellFree : kCellUnknown;
  }
}

OccupancyGrid FloorGrid::finish() {
  settle_blurred();
  confirm();
  clear_path();
  block_ways_out();
  cast_rays();
  fill_specks();
  return cropped(grid_, kMarginCells);
}

OccupancyGrid floor_grid(std::span<const MapPoint> points, const Floors& floors, const Floor& floor,
                         std::span<const Eigen::Vector3d> path, const GridConfig& config) {
  GroundColumns ground;
  ground.add(points);
  ground.finish();
  FloorGrid grid(ground, floors, floor, path, config);
  grid.add(points);
  return grid.finish();
}

}  // namespace isobar
