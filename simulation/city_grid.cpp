// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/city_grid.hpp"

namespace isobar::simulation {

namespace {

std::vector<Street> draw_streets(Random& random, int count) {
  std::vector<Street> streets;
  double axis_m = 0.0;
  for (int i = 0; i < count; ++i) {
    Street street;
    street.axis_m = axis_m;
    street.parking = random.chance(0.6);
    street.carriage_m = random.uniform(3.3, 3.7) + (street.parking ? 2.2 : 0.0);
    street.pavement_m = random.uniform(2.4, 5.0);
    if (street.pavement_m > 3.2 && random.chance(0.6)) street.tree_every_m = random.uniform(7.0, 14.0);
    streets.push_back(street);
    axis_m += random.uniform(62.0, 95.0);
  }
  return streets;
}

}  // namespace

CityGrid::CityGrid(Random random, int columns, int rows)
    : columns_(draw_streets(random, columns)), rows_(draw_streets(random, rows)) {}

Rect CityGrid::cell(const Crossing& block) const {
  return {column(block.x).axis_m, row(block.y).axis_m, column(block.x + 1).axis_m, row(block.y + 1).axis_m};
}

Rect CityGrid::island(const Crossing& block) const {
  const Rect all = cell(block);
  return {all.x0 + column(block.x).carriage_m, all.y0 + row(block.y).carriage_m,
          all.x1 - column(block.x + 1).carriage_m, all.y1 - row(block.y + 1).carriage_m};
}

}  // namespace isobar::simulation
