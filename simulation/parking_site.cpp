// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/parking_site.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/city_furniture.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kSlabM = 0.25;    // thickness of the floors
constexpr double kParapetM = 1.1;  // height of the parapets
constexpr double kFlat = ParkingSizes::kFlatRad;
constexpr double kTurn = 2.0 * std::numbers::pi;

Vector3d on_circle(double radius_m, double angle_rad, double z_m) {
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m};
}

class ParkingBuilder {
 public:
  ParkingBuilder(const ParkingSizes& sizes, Random& random)
      : sizes_(sizes), random_(random), solid_core_(random.chance(0.4)) {}

  [[nodiscard]] Mesh build() {
    add_lane();
    add_pillars_of_lane();
    for (int level = 0; level <= sizes_.top; ++level) add_deck(level);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] double end_rad() const { return kTurn * sizes_.top + kFlat; }
  /// Height of walls above the lane: up to the slab above, or a parapet under the sky.
  [[nodiscard]] double wall_m(double angle_rad) const {
    return angle_rad < end_rad() - kTurn ? sizes_.storey_m - kSlabM : kParapetM;
  }

  /// Curved wall at a radius between two angles, from the slab's underside to `above_m` over the lane.
  void add_wall(double radius_m, double from, double to, double above_m) {
    const double z0 = sizes_.lane_m(from);
    const double z1 = sizes_.lane_m(to);
    mesh_.quad(on_circle(radius_m, from, z0 - kSlabM), on_circle(radius_m, to, z1 - kSlabM),
               on_circle(radius_m, to, z1 + above_m), on_circle(radius_m, from, z0 + above_m),
               Surface::kConcrete);
  }

  /// Wall across the lane.
  void add_end(double angle_rad, double above_m) {
    const double z = sizes_.lane_m(angle_rad);
    mesh_.quad(on_circle(sizes_.inner_m(), angle_rad, z), on_circle(sizes_.outer_m(), angle_rad, z),
               on_circle(sizes_.outer_m(), angle_rad, z + above_m),
               on_circle(sizes_.inner_m(), angle_rad, z + above_m), Surface::kConcrete);
  }

  void add_lane() {
    constexpr double kStep = kFlat / 8.0;  // 4.7 degrees: flat pieces deviate by 1 cm from the circle
    const auto pieces = static_cast<int>(std::round((end_rad() + kFlat) / kStep));
    for (int i = 0; i < pieces; ++i) {
      const double from = -kFlat + i * (end_rad() + kFlat) / pieces;
      const double to = -kFlat + (i + 1) * (end_rad() + kFlat) / pieces;
      for (const double below : {0.0, kSlabM}) {
        const double z0 = sizes_.lane_m(from) - below;
        const double z1 = sizes_.lane_m(to) - below;
        mesh_.quad(on_circle(sizes_.inner_m(), from, z0), on_circle(sizes_.outer_m(), from, z0),
                   on_circle(sizes_.outer_m(), to, z1), on_circle(sizes_.inner_m(), to, z1),
                   Surface::kConcrete);
      }
      const double middle = 0.5 * (from + to);
      add_wall(sizes_.inner_m(), from, to, solid_core_ ? wall_m(middle) : kParapetM);
      const bool joins_deck = std::abs(std::remainder(middle, kTurn)) < kFlat;
      if (!joins_deck) add_wall(sizes_.outer_m(), from, to, wall_m(middle));
    }
    add_end(-kFlat, sizes_.storey_m - kSlabM);
    add_end(end_rad(), kParapetM);
  }

  /// Pillars at the inner edge, pilasters at the outer wall.
  void add_pillars_of_lane() {
    for (double angle = random_.uniform(0.0, 0.5); angle < end_rad(); angle += random_.uniform(0.5, 0.9)) {
      const double z = sizes_.lane_m(angle) - 0.1;
      const double high = wall_m(angle) + 0.1;
      mesh_.prism(on_circle(sizes_.inner_m() + 0.1, angle, z), 0.2, high, 8, Surface::kConcrete);
      const double outer = angle + random_.uniform(0.1, 0.4);
      if (std::abs(std::remainder(outer, kTurn)) < kFlat + 0.05 || outer > end_rad()) continue;
      mesh_.prism(on_circle(sizes_.outer_m(), outer, sizes_.lane_m(outer) - 0.1), random_.uniform(0.1, 0.25),
                  wall_m(outer) + 0.1, 6, Surface::kConcrete);
    }
  }

  void add_deck(int level) {
    const double z = sizes_.storey_m * level;
    const double x0 = sizes_.deck_start_m();
    const double x1 = x0 + sizes_.deck_m;
    const double half = sizes_.deck_half_m;
    const bool roofed = level < sizes_.top;
    const auto slab = [&](double at) {
      mesh_.quad({x0, -half, at}, {x1, -half, at}, {x1, half, at}, {x0, half, at}, Surface::kConcrete);
    };
    slab(z);
    if (level > 0) slab(z - kSlabM);
    const double near_m = roofed ? sizes_.storey_m - kSlabM : kParapetM;
    const double opening = sizes_.outer_m() * std::sin(kFlat);
    for (const double side : {-1.0, 1.0}) {
      add_panel({x0, side * opening}, {x0, side * half}, z, near_m);
      add_panel({x0, side * half}, {x1, side * half}, z, kParapetM);
      add_row(level, side);
    }
    add_panel({x1, -half}, {x1, half}, z, kParapetM);
    if (roofed) add_columns(z);
  }

  void add_panel(const Vector2d& a, const Vector2d& b, double z_m, double above_m) {
    mesh_.quad({a.x(), a.y(), z_m - kSlabM}, {b.x(), b.y(), z_m - kSlabM}, {b.x(), b.y(), z_m + above_m},
               {a.x(), a.y(), z_m + above_m}, Surface::kConcrete);
  }

  void add_columns(double z_m) {
    constexpr double kHalfColumnM = 0.2;
    constexpr double kBayM = 7.5;
    for (double x = sizes_.deck_start_m() + 4.0; x < sizes_.deck_start_m() + sizes_.deck_m - 1.0;
         x += kBayM) {
      for (const double y : {-kBayM, 0.0, kBayM}) {
        mesh_.box({x - kHalfColumnM, y - kHalfColumnM, z_m},
                  {x + kHalfColumnM, y + kHalfColumnM, z_m + sizes_.storey_m - kSlabM}, Surface::kConcrete);
      }
    }
  }

  /// Cars parked with their noses to the parapet of one side.
  void add_row(int level, double side) {
    constexpr double kPlaceM = 2.7;
    for (double x = sizes_.deck_start_m() + 3.0; x < sizes_.deck_start_m() + sizes_.deck_m - 2.0;
         x += kPlaceM) {
      if (random_.chance(0.45)) continue;
      CityFrame frame;
      frame.origin_m = {x + random_.uniform(-0.2, 0.2),
                        side * (sizes_.deck_half_m - 2.5 + random_.uniform(-0.2, 0.2)),
                        sizes_.storey_m * level};
      frame.along = Vector2d(0.0, random_.chance(0.8) ? side : -side);
      frame.out = Vector2d(1.0, 0.0);
      add_car(mesh_, frame, random_);
    }
  }

  const ParkingSizes& sizes_;
  Random& random_;
  bool solid_core_;  ///< a wall instead of a parapet towards the axis
  Mesh mesh_;
};

}  // namespace

ParkingSizes ParkingSizes::draw(Random& random, int top) {
  ParkingSizes sizes;
  sizes.top = top;
  sizes.storey_m = random.uniform(2.8, 3.2);
  sizes.radius_m = random.uniform(8.5, 10.5);
  sizes.deck_m = random.uniform(24.0, 32.0);
  return sizes;
}

double ParkingSizes::deck_start_m() const { return outer_m() * std::cos(kFlatRad); }

double ParkingSizes::lane_m(double angle_rad) const {
  const double turns = std::floor((angle_rad + kFlatRad) / kTurn);
  const double within = angle_rad - turns * kTurn;  // -kFlatRad … 2 pi - kFlatRad
  return storey_m * (turns + std::clamp((within - kFlatRad) / (kTurn - 2.0 * kFlatRad), 0.0, 1.0));
}

Mesh build_parking(const ParkingSizes& sizes, Random& random) {
  return ParkingBuilder(sizes, random).build();
}

}  // namespace isobar::simulation
