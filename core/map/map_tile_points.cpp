// SPDX-License-Identifier: BSD-3-Clause
// Points of a tile for files and viewers.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/map/map_tile.hpp"

namespace isobar {

namespace {

constexpr int kThirds = 3;  // sub-cells along the edge of a cell
constexpr int kSubCells = kThirds * kThirds * kThirds;

// Index of a sub-cell along each axis, 0 … 2. `bit`: its bit in MapCell::occupied_sub_cells.
Eigen::Vector3i sub_cell(int bit) {
  return {bit % kThirds, bit / kThirds % kThirds, bit / (kThirds * kThirds)};
}

// Centre of a sub-cell from the cell's centre [m].
Eigen::Vector3f sub_cell_centre(const Eigen::Vector3i& sub, float cell_m) {
  return (sub.cast<float>().array() - 1.0F) * (cell_m / kThirds);
}

// Moves `p_cell` along `axis` onto the plane. False if it ends outside the cell by more than a third of the
// edge: that much is accepted, since noise may have carried the points across the cell's border.
bool project_onto_plane(const Eigen::Vector3f& q_cell, const Eigen::Vector3f& normal, Eigen::Index axis,
                        float cell_m, Eigen::Vector3f& p_cell) {
  p_cell[axis] = 0.0F;
  p_cell[axis] = normal.dot(q_cell - p_cell) / normal[axis];
  return std::abs(p_cell[axis]) < cell_m * (0.5F + 1.0F / kThirds);
}

struct CellPlace {
  Eigen::Vector3d centre_map;
  float cell_m;
};

// A point of the cell. `p_cell`: from its centre [m].
MapPoint point_of(const MapCell& cell, const CellPlace& place, const Eigen::Vector3f& p_cell,
                  const Eigen::Vector3f& normal) {
  MapPoint point;
  point.p_map = place.centre_map + p_cell.cast<double>();
  point.normal_map = normal;
  point.intensity = cell.intensity;
  point.observations = static_cast<std::uint8_t>(cell.moments.count());
  point.filled = static_cast<std::uint8_t>(std::popcount(cell.occupied_sub_cells));
  return point;
}

// One point per column of sub-cells along the axis nearest to the normal. `q_cell`: the plane's point from
// the cell's centre [m].
void append_plane_points(const MapCell& cell, const CellPlace& place, const Eigen::Vector3f& q_cell,
                         const Eigen::Vector3f& normal, std::vector<MapPoint>& points) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  std::array<bool, std::size_t{kThirds} * kThirds> done{};
  for (int bit = 0; bit < kSubCells; ++bit) {
    if ((cell.occupied_sub_cells >> static_cast<unsigned>(bit) & 1U) == 0) continue;
    const Eigen::Vector3i sub = sub_cell(bit);
    const int column = sub[(axis + 1) % 3] * kThirds + sub[(axis + 2) % 3];
    Eigen::Vector3f p_cell = sub_cell_centre(sub, place.cell_m);
    if (done.at(static_cast<std::size_t>(column)) ||
        !project_onto_plane(q_cell, normal, axis, place.cell_m, p_cell)) {
      continue;
    }
    done.at(static_cast<std::size_t>(column)) = true;
    points.push_back(point_of(cell, place, p_cell, normal));
  }
}

void append_sub_cell_centres(const MapCell& cell, const CellPlace& place, std::vector<MapPoint>& points) {
  for (int bit = 0; bit < kSubCells; ++bit) {
    if ((cell.occupied_sub_cells >> static_cast<unsigned>(bit) & 1U) == 0) continue;
    const Eigen::Vector3f p_cell = sub_cell_centre(sub_cell(bit), place.cell_m);
    points.push_back(point_of(cell, place, p_cell, Eigen::Vector3f::Zero()));
  }
}

}  // namespace

void MapTile::append_points(float cell_m, std::vector<MapPoint>& points) const {
  const float half_block_m = 0.5F * kBlockCells * cell_m;
  for (std::size_t i = 0; i < kBlocksPerTile; ++i) {
    const MapBlock* block = this->block(i);
    if (block == nullptr) continue;
    const CellIndex first = first_cell(key_, i);
    for (const MapCell& cell : block->cells()) {
      const CellIndex offset = offset_of(cell.slot % kPlacesPerBlock);
      const CellPlace place{((first + offset).cast<double>().array() + 0.5) * static_cast<double>(cell_m),
                            cell_m};
      if (const PackedPlane* plane = block->plane_at(cell.slot)) {
        const Eigen::Vector3f centre_block = (offset.cast<float>().array() + 0.5F) * cell_m - half_block_m;
        append_plane_points(cell, place, plane->q_block(cell_m) - centre_block, plane->unit_normal(), points);
      } else {
        append_sub_cell_centres(cell, place, points);
      }
    }
  }
}

}  // namespace isobar
