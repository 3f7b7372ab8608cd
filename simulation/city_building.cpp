// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/city_building.hpp"

#include <algorithm>

namespace isobar::simulation {

namespace {

constexpr double kFootM = -4.0;    // walls extend into the ground, since it slopes along the house
constexpr double kDetailM = 13.0;  // no windows above this height: the lidar sees it only from far away
constexpr Surface kGlass = Surface::kIce;  // the most similar surface

/// Opening in a wall [m]; `depth_m`: distance of the pane or door behind the wall.
struct Opening {
  double u0, u1;
  double z0, z1;
  double depth_m;
  Surface pane;
};

struct Style {
  Surface wall;
  double floor_m;
  double ground_floor_m;
  int floors;  ///< above the ground floor
  int bays;
  double bay_m;
  double window_share;
  double window_depth_m;

  [[nodiscard]] double top_m() const { return ground_floor_m + floors * floor_m + 0.5; }
};

Style draw_style(Random& random, double width_m) {
  Style style{};
  style.wall = random.chance(0.6) ? Surface::kPlaster : Surface::kConcrete;
  style.floor_m = random.uniform(2.8, 3.6);
  style.ground_floor_m = random.uniform(3.3, 4.6);
  style.floors = random.integer(1, 5);
  style.bays = std::max(1, static_cast<int>(width_m / random.uniform(2.6, 4.0)));
  style.bay_m = width_m / style.bays;
  style.window_share = random.uniform(0.35, 0.65);
  style.window_depth_m = random.uniform(0.08, 0.30);
  return style;
}

/// The wall of one bay on one floor, around its opening.
void add_bay(Mesh& mesh, const CityFrame& frame, double u0, double u1, double z0, double z1,
             const Opening& hole, Surface wall) {
  frame.panel(mesh, u0, hole.u0, 0.0, z0, z1, wall);
  frame.panel(mesh, hole.u1, u1, 0.0, z0, z1, wall);
  frame.panel(mesh, hole.u0, hole.u1, 0.0, z0, hole.z0, wall);
  frame.panel(mesh, hole.u0, hole.u1, 0.0, hole.z1, z1, wall);
  frame.panel(mesh, hole.u0, hole.u1, -hole.depth_m, hole.z0, hole.z1, hole.pane);
  for (const double u : {hole.u0, hole.u1}) frame.flank(mesh, u, -hole.depth_m, 0.0, hole.z0, hole.z1, wall);
  for (const double z : {hole.z0, hole.z1}) frame.slab(mesh, hole.u0, hole.u1, -hole.depth_m, 0.0, z, wall);
}

/// Opening on the ground floor: door, shop window, garage, or window of a flat.
Opening draw_street_opening(Random& random, double u0, double bay_m, double height_m) {
  const double middle = u0 + bay_m * random.uniform(0.45, 0.55);
  const double kind = random.uniform();
  if (kind < 0.20) {
    const double half = std::min(random.uniform(0.5, 0.9), 0.4 * bay_m);
    return {middle - half, middle + half, -0.5, 2.3, random.uniform(0.25, 1.1), Surface::kWood};
  }
  if (kind < 0.55) {
    const double half = 0.42 * bay_m;
    const double head_m = height_m - random.uniform(0.5, 1.0);
    return {middle - half, middle + half, random.uniform(0.1, 0.7), head_m, random.uniform(0.1, 0.6), kGlass};
  }
  if (kind < 0.65) {
    const double half = std::min(1.3, 0.42 * bay_m);
    return {middle - half, middle + half, -0.5, 2.5, random.uniform(0.3, 1.5), Surface::kMetal};
  }
  const double half = 0.5 * random.uniform(0.3, 0.55) * bay_m;
  return {middle - half, middle + half, random.uniform(0.9, 1.3), 2.6, random.uniform(0.1, 0.3), kGlass};
}

/// A bay window from the first floor upwards.
void add_oriel(Mesh& mesh, const CityFrame& frame, const Style& style, double u0, double top_m,
               Random& random) {
  const double depth = random.uniform(0.5, 1.0);
  const double inset = 0.12 * style.bay_m;
  frame.box(mesh, u0 + inset, u0 + style.bay_m - inset, 0.0, depth, style.ground_floor_m - 0.2, top_m,
            style.wall);
}

void add_balcony(Mesh& mesh, const CityFrame& frame, const Style& style, double u0, double z_m) {
  const double u1 = u0 + 0.95 * style.bay_m;
  constexpr double kDepthM = 1.1;
  frame.box(mesh, u0 + 0.05 * style.bay_m, u1, 0.0, kDepthM, z_m - 0.15, z_m, Surface::kConcrete);
  frame.panel(mesh, u0 + 0.05 * style.bay_m, u1, kDepthM, z_m, z_m + 1.0, Surface::kMetal);
}

void add_upper_floors(Mesh& mesh, const CityFrame& frame, const Style& style, Random& random) {
  const double top = style.top_m();
  const bool balconies = random.chance(0.35);
  const double oriel_top_m = std::min(top - 0.5, style.ground_floor_m + 2.0 * style.floor_m);
  std::vector<bool> has_oriel;
  for (int bay = 0; bay < style.bays; ++bay) {
    has_oriel.push_back(random.chance(0.12));
    if (has_oriel.back()) add_oriel(mesh, frame, style, bay * style.bay_m, oriel_top_m, random);
  }
  for (int floor = 0; floor < style.floors; ++floor) {
    const double z0 = style.ground_floor_m + floor * style.floor_m;
    if (z0 > kDetailM) break;
    for (int bay = 0; bay < style.bays; ++bay) {
      const double u0 = bay * style.bay_m;
      const double half = 0.5 * style.window_share * style.bay_m;
      const double middle = u0 + 0.5 * style.bay_m;
      const Opening window{middle - half,        middle + half, z0 + 0.9, z0 + style.floor_m - 0.4,
                           style.window_depth_m, kGlass};
      add_bay(mesh, frame, u0, u0 + style.bay_m, z0, z0 + style.floor_m, window, style.wall);
      if (balconies && !has_oriel[static_cast<std::size_t>(bay)] && random.chance(0.4)) {
        add_balcony(mesh, frame, style, u0, z0);
      }
    }
  }
  const int detailed =
      std::min(style.floors, static_cast<int>((kDetailM - style.ground_floor_m) / style.floor_m) + 1);
  frame.panel(mesh, 0.0, style.bays * style.bay_m, 0.0, style.ground_floor_m + detailed * style.floor_m, top,
              style.wall);
}

}  // namespace

void add_building(Mesh& mesh, const CityFrame& frame, double width_m, double depth_m, Random& random) {
  const Style style = draw_style(random, width_m);
  const double top = style.top_m();
  for (int bay = 0; bay < style.bays; ++bay) {
    const double u0 = bay * style.bay_m;
    add_bay(mesh, frame, u0, u0 + style.bay_m, kFootM, style.ground_floor_m,
            draw_street_opening(random, u0, style.bay_m, style.ground_floor_m), style.wall);
  }
  add_upper_floors(mesh, frame, style, random);
  for (const double u : {0.0, width_m}) frame.flank(mesh, u, -depth_m, 0.0, kFootM, top, style.wall);
  frame.panel(mesh, 0.0, width_m, -depth_m, kFootM, top, style.wall);
  frame.slab(mesh, 0.0, width_m, -depth_m, 0.0, top, Surface::kConcrete);
  if (random.chance(0.5)) {  // a doorstep or a shop's display
    const double u0 = random.uniform(0.0, std::max(0.1, width_m - 2.0));
    frame.box(mesh, u0, std::min(width_m, u0 + 1.4), 0.0, random.uniform(0.3, 0.6), -1.0,
              random.uniform(0.2, 0.5), Surface::kConcrete);
  }
  if (random.chance(0.5)) {
    const double reach = random.uniform(0.2, 0.5);
    frame.box(mesh, 0.0, width_m, 0.0, reach, top - 0.4, top, style.wall);
  }
}

}  // namespace isobar::simulation
