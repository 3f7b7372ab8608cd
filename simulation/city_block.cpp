// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/city_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/city_building.hpp"
#include "simulation/city_furniture.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Edge of a ground patch. The curvature of the hills is below 1/1000 m: a flat patch is off by 2 mm at most.
constexpr double kPatchM = 4.0;

int patches(double length_m) { return std::max(1, static_cast<int>(std::ceil(length_m / kPatchM))); }

void add_ground(Mesh& mesh, const Terrain& terrain, const Rect& rect, double above_m) {
  const int nx = patches(rect.x1 - rect.x0);
  const int ny = patches(rect.y1 - rect.y0);
  const auto point = [&](int i, int j) {
    const Vector2d xy(rect.x0 + (rect.x1 - rect.x0) * i / nx, rect.y0 + (rect.y1 - rect.y0) * j / ny);
    return Vector3d(xy.x(), xy.y(), terrain.height_m(xy) + above_m);
  };
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      mesh.quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1), Surface::kConcrete);
    }
  }
}

/// One side of a block, with the street along it.
struct Side {
  CityFrame kerb;
  double length_m;
  const Street* street;
};

std::array<Side, 4> sides(const CityGrid& grid, const Crossing& block) {
  const Rect r = grid.island(block);
  const double dx = r.x1 - r.x0;
  const double dy = r.y1 - r.y0;
  const auto frame = [](double x, double y, const Vector2d& along, const Vector2d& out) {
    return CityFrame{{x, y, 0.0}, along, out, 0.0};
  };
  const Vector2d ex = Vector2d::UnitX();
  const Vector2d ey = Vector2d::UnitY();
  return {Side{frame(r.x0, r.y0, ex, -ey), dx, &grid.row(block.y)},
          Side{frame(r.x0, r.y1, ex, ey), dx, &grid.row(block.y + 1)},
          Side{frame(r.x0, r.y0, ey, -ex), dy, &grid.column(block.x)},
          Side{frame(r.x1, r.y0, ey, ex), dy, &grid.column(block.x + 1)}};
}

void add_kerb(Mesh& mesh, const Terrain& terrain, const Side& side) {
  const int n = patches(side.length_m);
  const auto point = [&](int i, double z) {
    const Vector2d xy = side.kerb.plan(side.length_m * i / n, 0.0);
    return Vector3d(xy.x(), xy.y(), terrain.height_m(xy) + z);
  };
  for (int i = 0; i < n; ++i) {
    mesh.quad(point(i, 0.0), point(i + 1, 0.0), point(i + 1, kKerbM), point(i, kKerbM), Surface::kConcrete);
  }
}

/// A row of houses with different fronts and a few alleys between them, from one cross street's building line
/// to the other's.
void add_row_of_houses(Mesh& mesh, const Terrain& terrain, const Side& side, double from_m, double to_m,
                       Random& random) {
  double u = from_m;
  while (to_m - u > 4.0) {
    double width = random.uniform(8.0, 20.0);
    if (to_m - u - width < 7.0) width = to_m - u;
    CityFrame front = side.kerb;
    const double setback = random.chance(0.6) ? 0.0 : random.uniform(0.1, 1.6);
    front.origin_m.head<2>() = side.kerb.plan(u, -side.street->pavement_m - setback);
    front.origin_m.z() = terrain.height_m(front.plan(0.5 * width, 0.0)) + kKerbM;
    add_building(mesh, front, width, random.uniform(9.0, 13.0), random);
    u += width + (random.chance(0.15) ? random.uniform(1.8, 4.5) : 0.0);
  }
}

/// An open square: trees, hedges, a kiosk and a monument.
void add_square(Mesh& mesh, const Terrain& terrain, const Rect& rect, Random& random) {
  const Rect inner = rect.grown(-6.0);
  const auto draw_place = [&] {
    const double x = random.uniform(inner.x0, inner.x1);
    const double y = random.uniform(inner.y0, inner.y1);
    return Vector3d(x, y, terrain.height_m({x, y}) + kKerbM);
  };
  const int trees = random.integer(6, 25);
  for (int i = 0; i < trees; ++i) add_tree(mesh, draw_place(), random);
  const int boxes = random.integer(3, 8);
  for (int i = 0; i < boxes; ++i) {  // hedges, flower beds, kiosks
    const Vector3d at = draw_place();
    const bool kiosk = random.chance(0.2);
    const double x = kiosk ? 1.5 : random.uniform(0.4, 4.0);
    const double y = kiosk ? 1.5 : random.uniform(0.4, 4.0);
    const double height = kiosk ? 2.7 : random.uniform(0.4, 1.4);
    mesh.box(at - Vector3d(x, y, 1.0), at + Vector3d(x, y, height), kiosk ? Surface::kWood : Surface::kCloth);
  }
  const Vector3d monument(0.5 * (inner.x0 + inner.x1), 0.5 * (inner.y0 + inner.y1), 0.0);
  const double z = terrain.height_m(monument.head<2>());
  mesh.prism({monument.x(), monument.y(), z - 0.5}, 2.5, 1.0, 12, Surface::kConcrete);
  mesh.prism({monument.x(), monument.y(), z}, 0.7, random.uniform(3.0, 6.0), 9, Surface::kConcrete);
}

}  // namespace

void add_block(Mesh& mesh, const CityGrid& grid, const Terrain& terrain, const Crossing& block,
               std::uint64_t seed) {
  Random random(seed, "city block", static_cast<std::uint64_t>(block.x * 4096 + block.y));
  const Rect cell = grid.cell(block);
  const Rect island = grid.island(block);
  add_ground(mesh, terrain, island, kKerbM);
  add_ground(mesh, terrain, {cell.x0, cell.y0, cell.x1, island.y0}, 0.0);
  add_ground(mesh, terrain, {cell.x0, island.y1, cell.x1, cell.y1}, 0.0);
  add_ground(mesh, terrain, {cell.x0, island.y0, island.x0, island.y1}, 0.0);
  add_ground(mesh, terrain, {island.x1, island.y0, cell.x1, island.y1}, 0.0);
  const std::array<Side, 4> around = sides(grid, block);
  const bool square = random.chance(0.12);
  for (std::size_t i = 0; i < 4; ++i) {
    const Side& side = around[i];
    add_kerb(mesh, terrain, side);
    add_kerbside(mesh, side.kerb, side.length_m, *side.street, terrain, random);
    if (square) continue;
    const std::size_t across = i < 2 ? 2 : 0;  // the two sides at the ends of this one
    add_row_of_houses(mesh, terrain, side, around[across].street->pavement_m,
                      side.length_m - around[across + 1].street->pavement_m, random);
  }
  if (square) add_square(mesh, terrain, island, random);
}

}  // namespace isobar::simulation
