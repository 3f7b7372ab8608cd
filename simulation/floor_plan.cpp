// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/floor_plan.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

using Interval = std::pair<double, double>;

/// Wall faces on the border between two cells: the height intervals that are open in `mine` and solid in
/// `other`.
void add_difference(const Space* mine, const Space* other, std::vector<Interval>& faces) {
  if (mine == nullptr || mine->outdoors || mine == other) return;
  const double low = mine->floor_m;
  const double high = mine->ceiling_m;
  if (other == nullptr) {
    faces.emplace_back(low, high);
    return;
  }
  if (other->outdoors) return;
  if (other->floor_m > low) faces.emplace_back(low, std::min(high, other->floor_m));
  if (other->ceiling_m < high) faces.emplace_back(std::max(low, other->ceiling_m), high);
}

void sort_unique(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const auto close = [](double a, double b) { return b - a < 1e-9; };
  values.erase(std::unique(values.begin(), values.end(), close), values.end());
}

}  // namespace

Rect Rect::around(const Vector2d& a, const Vector2d& b, double margin_m) {
  return Rect{std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()), std::max(a.y(), b.y())}
      .grown(margin_m);
}

bool Rect::overlaps(const Rect& other) const {
  return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
}

/// Grid whose lines are the edges of all rectangles, with the space of each cell.
struct FloorPlan::Grid {
  std::vector<double> lines[2];  // NOLINT(modernize-avoid-c-arrays): x and y
  std::vector<const Space*> cells;

  [[nodiscard]] std::size_t count(int axis) const { return lines[axis].size() - 1; }
  [[nodiscard]] const Space* cell(std::size_t i, std::size_t j) const {
    return i < count(0) && j < count(1) ? cells[i * count(1) + j] : nullptr;
  }
};

const Space* FloorPlan::at(double x, double y) const {
  const auto found = std::find_if(spaces_.rbegin(), spaces_.rend(),
                                  [&](const Space& space) { return space.rect.contains(x, y); });
  return found == spaces_.rend() ? nullptr : &*found;
}

void FloorPlan::build(Mesh& mesh, double z_m) const {
  if (spaces_.empty()) return;
  Grid grid;
  for (const Space& space : spaces_) {
    grid.lines[0].insert(grid.lines[0].end(), {space.rect.x0, space.rect.x1});
    grid.lines[1].insert(grid.lines[1].end(), {space.rect.y0, space.rect.y1});
  }
  sort_unique(grid.lines[0]);
  sort_unique(grid.lines[1]);
  for (std::size_t i = 0; i < grid.count(0); ++i) {
    for (std::size_t j = 0; j < grid.count(1); ++j) {
      grid.cells.push_back(at(0.5 * (grid.lines[0][i] + grid.lines[0][i + 1]),
                              0.5 * (grid.lines[1][j] + grid.lines[1][j + 1])));
    }
  }
  add_levels(mesh, grid, z_m);
  add_walls(mesh, grid, z_m, 0);
  add_walls(mesh, grid, z_m, 1);
}

void FloorPlan::add_levels(Mesh& mesh, const Grid& grid, double z_m) const {
  for (std::size_t j = 0; j < grid.count(1); ++j) {
    for (std::size_t i = 0; i < grid.count(0);) {
      const Space* space = grid.cell(i, j);
      std::size_t end = i + 1;
      while (end < grid.count(0) && grid.cell(end, j) == space) ++end;
      const double x0 = grid.lines[0][i];
      const double x1 = grid.lines[0][end];
      const double y0 = grid.lines[1][j];
      const double y1 = grid.lines[1][j + 1];
      i = end;
      if (space == nullptr || space->outdoors) continue;
      const auto level = [&](double z, Surface surface) {
        mesh.quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}, surface);
      };
      if (space->has_floor) level(z_m + space->floor_m, Surface::kConcrete);
      if (space->has_ceiling) level(z_m + space->ceiling_m, Surface::kPlaster);
    }
  }
}

void FloorPlan::add_walls(Mesh& mesh, const Grid& grid, double z_m, int axis) const {
  // Walls perpendicular to `axis`: on each grid line of that axis, equal faces of consecutive cells are
  // merged along the other axis.
  const int along = 1 - axis;
  const auto cell = [&](std::size_t line, std::size_t other) {
    return axis == 0 ? grid.cell(line, other) : grid.cell(other, line);
  };
  for (std::size_t line = 0; line < grid.lines[axis].size(); ++line) {
    std::map<Interval, std::size_t> open;
    for (std::size_t k = 0; k <= grid.count(along); ++k) {
      std::vector<Interval> faces;
      if (k < grid.count(along)) {
        const Space* before = line > 0 ? cell(line - 1, k) : nullptr;
        const Space* after = cell(line, k);
        add_difference(before, after, faces);
        add_difference(after, before, faces);
      }
      for (auto wall = open.begin(); wall != open.end();) {
        if (std::find(faces.begin(), faces.end(), wall->first) != faces.end()) {
          ++wall;
          continue;
        }
        const auto corner = [&](double other, double z) {
          const double at = grid.lines[axis][line];
          return axis == 0 ? Vector3d(at, other, z_m + z) : Vector3d(other, at, z_m + z);
        };
        const double from = grid.lines[along][wall->second];
        const double to = grid.lines[along][k];
        const auto [low, high] = wall->first;
        mesh.quad(corner(from, low), corner(to, low), corner(to, high), corner(from, high),
                  Surface::kPlaster);
        wall = open.erase(wall);
      }
      for (const Interval& face : faces) open.try_emplace(face, k);
    }
  }
}

}  // namespace isobar::simulation
