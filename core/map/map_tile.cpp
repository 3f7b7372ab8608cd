// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_tile.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {

constexpr std::size_t kFirstTableSize = 256;
constexpr int kSubPerEdge = 3;
// A plane that turns away from the ray by more than this is the other side of a thin wall.
constexpr float kOtherSide = -0.15F;

int clamp_cell(float coordinate, int count) {
  return std::clamp(static_cast<int>(std::floor(coordinate)), 0, count - 1);
}

}  // namespace

MapTile::MapTile(const TileKey& key, int cells_per_edge)
    : key_(key),
      cells_per_edge_(cells_per_edge),
      cell_m_(static_cast<float>(kTileSizeM) / static_cast<float>(cells_per_edge)),
      table_(kFirstTableSize, -1) {}

std::uint32_t MapTile::key_of(const Eigen::Vector3f& p_tile) const {
  const int n = cells_per_edge_;
  const int x = clamp_cell(p_tile.x() / cell_m_, n);
  const int y = clamp_cell(p_tile.y() / cell_m_, n);
  const int z = clamp_cell(p_tile.z() / cell_m_, n);
  return static_cast<std::uint32_t>(((x * n + y) * n + z) * 2);
}

Eigen::Vector3i MapTile::cell_coordinates(std::uint32_t cell_key) const {
  const int n = cells_per_edge_;
  const int place = static_cast<int>(cell_key / 2);
  return {place / (n * n), place / n % n, place % n};
}

Eigen::Vector3f MapTile::cell_centre_tile(std::uint32_t cell_key) const {
  return (cell_coordinates(cell_key).cast<float>().array() + 0.5F) * cell_m_;
}

std::ptrdiff_t MapTile::find(std::uint32_t cell_key) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = (cell_key * 2654435761U >> 7) & mask;
  while (table_[slot] >= 0) {
    if (cells_[static_cast<std::size_t>(table_[slot])].key == cell_key) {
      return table_[slot];
    }
    slot = (slot + 1) & mask;
  }
  return -1;
}

void MapTile::grow_table() {
  table_.assign(table_.size() * 2, -1);
  const std::size_t mask = table_.size() - 1;
  for (std::size_t index = 0; index < cells_.size(); ++index) {
    std::size_t slot = (cells_[index].key * 2654435761U >> 7) & mask;
    while (table_[slot] >= 0) {
      slot = (slot + 1) & mask;
    }
    table_[slot] = static_cast<std::int32_t>(index);
  }
}

MapCell& MapTile::find_or_add(std::uint32_t cell_key) {
  const std::ptrdiff_t found = find(cell_key);
  if (found >= 0) {
    return cells_[static_cast<std::size_t>(found)];
  }
  cells_.emplace_back().key = cell_key;
  if (cells_.size() * 2 > table_.size()) {
    grow_table();
    return cells_.back();
  }
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = (cell_key * 2654435761U >> 7) & mask;
  while (table_[slot] >= 0) {
    slot = (slot + 1) & mask;
  }
  table_[slot] = static_cast<std::int32_t>(cells_.size() - 1);
  return cells_.back();
}

std::ptrdiff_t MapTile::observe(const Eigen::Vector3f& p_tile, const Eigen::Vector3f& toward,
                                std::uint8_t intensity, float freeze) {
  const std::uint32_t first_side = key_of(p_tile);
  MapCell* cell = &find_or_add(first_side);
  if (cell->has_plane && cell->normal.dot(toward) < kOtherSide) {
    cell = &find_or_add(first_side + 1);
  }
  const Eigen::Vector3f p_centre = p_tile - cell_centre_tile(first_side);
  if (cell->moments.count == 0.0F) {
    cell->toward = toward;
  }
  cell->seen_through = cell->seen_through > 0 ? cell->seen_through - 1 : 0;
  keep_point(*cell, p_centre, p_tile, intensity);
  if (cell->moments.count >= freeze) {
    return -1;
  }
  cell->moments.add(p_centre);
  Eigen::Vector3f coarse_centre;
  coarse_[coarse_index(p_tile, coarse_centre)].add(p_tile - coarse_centre);
  // A plane that exists is fitted again when a quarter more is known; one that does not, at every chance.
  if (cell->touched ||
      (cell->has_plane && cell->moments.count < 1.25F * cell->fitted_count && cell->moments.count < freeze)) {
    return -1;
  }
  cell->touched = true;
  return cell - cells_.data();
}

void MapTile::keep_point(MapCell& cell, const Eigen::Vector3f& p_centre, const Eigen::Vector3f& p_tile,
                         std::uint8_t intensity) {
  const Eigen::Array3f sub = (p_centre.array() / cell_m_ + 0.5F) * kSubPerEdge;
  const int bit =
      (clamp_cell(sub.x(), kSubPerEdge) * kSubPerEdge + clamp_cell(sub.y(), kSubPerEdge)) * kSubPerEdge +
      clamp_cell(sub.z(), kSubPerEdge);
  const std::uint32_t mask = 1U << static_cast<unsigned>(bit);
  if ((cell.occupied_sub_cells & mask) == 0) {
    cell.occupied_sub_cells |= mask;
    points_.push_back({p_tile, static_cast<std::uint32_t>(&cell - cells_.data()), intensity});
  }
}

std::size_t MapTile::coarse_index(const Eigen::Vector3f& p_tile, Eigen::Vector3f& centre_tile) {
  constexpr float kEdge = static_cast<float>(kTileSizeM) / kCoarsePerEdge;
  const int x = clamp_cell(p_tile.x() / kEdge, kCoarsePerEdge);
  const int y = clamp_cell(p_tile.y() / kEdge, kCoarsePerEdge);
  const int z = clamp_cell(p_tile.z() / kEdge, kCoarsePerEdge);
  centre_tile = (Eigen::Vector3i(x, y, z).cast<float>().array() + 0.5F) * kEdge;
  const int index = (x * kCoarsePerEdge + y) * kCoarsePerEdge + z;
  return static_cast<std::size_t>(index);
}

const Moments& MapTile::coarse_at(const Eigen::Vector3f& p_tile, Eigen::Vector3f& centre_tile) const {
  return coarse_[coarse_index(p_tile, centre_tile)];
}

bool MapTile::unknown_at(const Eigen::Vector3f& p_tile) const {
  Eigen::Vector3f centre;
  return coarse_planes_[coarse_index(p_tile, centre)] == 0;
}

void MapTile::set_plane(MapCell& cell, const Plane& plane) {
  if (!cell.has_plane) {
    Eigen::Vector3f coarse_centre;
    ++coarse_planes_[coarse_index(cell_centre_tile(cell.key), coarse_centre)];
  }
  cell.has_plane = true;
  cell.normal = plane.normal.dot(cell.toward) < 0.0F ? (-plane.normal).eval() : plane.normal;
  cell.q_tile = plane.mean;
  cell.fitted_count = cell.moments.count;
  changed_ = true;
}

void MapTile::clear_plane(MapCell& cell) {
  if (!cell.has_plane) {
    return;
  }
  Eigen::Vector3f coarse_centre;
  --coarse_planes_[coarse_index(cell_centre_tile(cell.key), coarse_centre)];
  cell.has_plane = false;
  changed_ = true;
}

const MapCell* MapTile::cell_at(int x, int y, int z, int side) const {
  const int n = cells_per_edge_;
  const std::ptrdiff_t index = find(static_cast<std::uint32_t>(((x * n + y) * n + z) * 2 + side));
  return index < 0 ? nullptr : &cells_[static_cast<std::size_t>(index)];
}

std::size_t MapTile::remove_seen_through(std::uint16_t limit) {
  std::size_t removed = 0;
  for (MapCell& cell : cells_) {
    if (cell.seen_through <= limit || cell.moments.count == 0.0F) {
      continue;
    }
    // The coarse moments lose it too, else they go on to give normals of what is no longer there.
    Eigen::Vector3f coarse_centre;
    const Eigen::Vector3f centre = cell_centre_tile(cell.key);
    Moments& coarse = coarse_[coarse_index(centre, coarse_centre)];
    Moments negative = cell.moments;
    negative.count = -negative.count;
    negative.sum = -negative.sum;
    negative.outer_diagonal = -negative.outer_diagonal;
    negative.outer_off_diagonal = -negative.outer_off_diagonal;
    coarse.add(negative, centre - coarse_centre);
    if (coarse.count < 0.5F) {
      coarse = Moments{};
    }
    clear_plane(cell);
    const std::uint32_t key = cell.key;
    cell = MapCell{};
    cell.key = key;
    ++removed;
  }
  if (removed > 0) {
    std::erase_if(points_,
                  [this](const KeptPoint& point) { return cells_[point.cell].moments.count == 0.0F; });
    changed_ = true;
  }
  return removed;
}

bool MapTile::rebuild_index() {
  if (!changed_) {
    return false;
  }
  changed_ = false;
  std::vector<TilePlane> planes;
  planes.reserve(cells_.size());
  for (const MapCell& cell : cells_) {
    if (cell.has_plane) {
      planes.push_back({cell.q_tile, cell.normal});
    }
  }
  index_ = std::make_shared<const TileIndex>(key_, std::move(planes));
  return true;
}

void MapTile::append_points(std::vector<MapPoint>& points) const {
  const Eigen::Vector3d origin = key_.origin_map();
  points.reserve(points.size() + points_.size());
  for (const KeptPoint& point : points_) {
    const MapCell& cell = cells_[point.cell];
    points.push_back({origin + point.p_tile.cast<double>(),
                      cell.has_plane ? cell.normal : Eigen::Vector3f::Zero().eval(), point.intensity});
  }
}

}  // namespace isobar
