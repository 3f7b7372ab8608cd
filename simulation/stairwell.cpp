// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/stairwell.hpp"

#include <algorithm>

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kSlabM = 0.25;  // thickness of a storey's floor
constexpr Surface kStone = Surface::kConcrete;

}  // namespace

StairSizes StairSizes::draw(Random& random, int steps_low, int steps_high) {
  StairSizes sizes;
  sizes.steps = random.integer(steps_low, steps_high);
  sizes.rise_m = random.uniform(0.166, 0.176);
  sizes.going_m = 0.63 - 2.0 * sizes.rise_m;
  return sizes;
}

Stairwell::Stairwell(const Vector2d& entrance_m, const Vector2d& away, double side, const StairSizes& sizes)
    : entrance_m_(entrance_m), u_(away), v_(side * Vector2d(-away.y(), away.x())), sizes_(sizes) {}

Vector2d Stairwell::plan(double u, double v) const { return entrance_m_ + u * u_ + v * v_; }

Vector3d Stairwell::point(double u, double v, double z) const {
  const Vector2d xy = plan(u, v);
  return {xy.x(), xy.y(), z};
}

Rect Stairwell::rect() const {
  return Rect::around(plan(0.0, -kHalfLaneM),
                      plan(kLandingM + run_m() + kHalfLandingM, kLaneGapM + kHalfLaneM));
}

void Stairwell::cut_lower(FloorPlan& storey) const {
  const double end = kLandingM + run_m() + kHalfLandingM;
  const double top = sizes_.storey_m();
  storey.cut(
      {Rect::around(plan(0.0, -kHalfLaneM), plan(kLandingM, kLaneGapM + kHalfLaneM)), 0.0, top - kSlabM});
  storey.cut(
      {Rect::around(plan(kLandingM, -kHalfLaneM), plan(end, kLaneGapM + kHalfLaneM)), 0.0, top, true, false});
}

void Stairwell::cut_upper(FloorPlan& storey, double ceiling_m) const {
  const double end = kLandingM + run_m() + kHalfLandingM;
  storey.cut({Rect::around(plan(0.0, -kHalfLaneM), plan(kLandingM, kLaneGapM + kHalfLaneM)), 0.0, ceiling_m});
  storey.cut({Rect::around(plan(kLandingM, -kHalfLaneM), plan(end, kLaneGapM + kHalfLaneM)), 0.0, ceiling_m,
              false, true});
}

void Stairwell::cut_middle(FloorPlan& storey) const {
  const double end = kLandingM + run_m() + kHalfLandingM;
  const double top = sizes_.storey_m();
  storey.cut(
      {Rect::around(plan(0.0, -kHalfLaneM), plan(kLandingM, kLaneGapM + kHalfLaneM)), 0.0, top - kSlabM});
  storey.cut({Rect::around(plan(kLandingM, -kHalfLaneM), plan(end, kLaneGapM + kHalfLaneM)), 0.0, top, false,
              false});
}

void Stairwell::add_flight(Mesh& mesh, double start_u, double direction, double v, double z_m) const {
  const double low = v - kHalfLaneM;
  const double high = v + kHalfLaneM;
  for (int k = 0; k < sizes_.steps; ++k) {
    const double u = start_u + direction * k * sizes_.going_m;
    const double next_u = u + direction * sizes_.going_m;
    const double z = z_m + k * sizes_.rise_m;
    const double next_z = z + sizes_.rise_m;
    mesh.quad(point(u, low, z), point(u, high, z), point(u, high, next_z), point(u, low, next_z), kStone);
    if (k + 1 == sizes_.steps) break;
    mesh.quad(point(u, low, next_z), point(u, high, next_z), point(next_u, high, next_z),
              point(next_u, low, next_z), kStone);
  }
  const double end_u = start_u + direction * run_m();
  const double top_z = z_m + sizes_.flight_m();
  mesh.quad(point(start_u, low, z_m - 0.15), point(start_u, high, z_m - 0.15),
            point(end_u, high, top_z - sizes_.rise_m - 0.15), point(end_u, low, top_z - sizes_.rise_m - 0.15),
            kStone);
}

void Stairwell::add_parapet(Mesh& mesh, double start_u, double direction, double v, double z_m) const {
  const double end_u = start_u + direction * run_m();
  const double top_z = z_m + sizes_.flight_m();
  mesh.quad(point(start_u, v, z_m - 0.2), point(end_u, v, top_z - sizes_.rise_m - 0.2),
            point(end_u, v, top_z + 0.9), point(start_u, v, z_m + sizes_.rise_m + 0.9), Surface::kMetal);
}

void Stairwell::build(Mesh& mesh, double z_m, bool goes_on) const {
  const double far_u = kLandingM + run_m();
  const double half_z = z_m + sizes_.flight_m();
  add_flight(mesh, kLandingM, 1.0, 0.0, z_m);
  add_flight(mesh, far_u, -1.0, kLaneGapM, half_z);
  add_parapet(mesh, kLandingM, 1.0, kHalfLaneM, z_m);
  add_parapet(mesh, far_u, -1.0, kLaneGapM - kHalfLaneM, half_z);
  const auto slab = [&](double z) {
    mesh.quad(point(far_u, -kHalfLaneM, z), point(far_u + kHalfLandingM, -kHalfLaneM, z),
              point(far_u + kHalfLandingM, kLaneGapM + kHalfLaneM, z),
              point(far_u, kLaneGapM + kHalfLaneM, z), kStone);
  };
  slab(half_z);
  slab(half_z - 0.2);
  mesh.quad(point(far_u, -kHalfLaneM, half_z - 0.2), point(far_u, kLaneGapM + kHalfLaneM, half_z - 0.2),
            point(far_u, kLaneGapM + kHalfLaneM, half_z), point(far_u, -kHalfLaneM, half_z), kStone);
  if (goes_on) return;
  // Balustrade of the upper landing, beside the upper flight.
  const double top_z = z_m + sizes_.storey_m();
  mesh.quad(point(kLandingM, -kHalfLaneM, top_z), point(kLandingM, kLaneGapM - kHalfLaneM, top_z),
            point(kLandingM, kLaneGapM - kHalfLaneM, top_z + 1.0), point(kLandingM, -kHalfLaneM, top_z + 1.0),
            Surface::kMetal);
}

void Stairwell::route_up(std::vector<Waypoint>& way, double z_m, double speed_m_s) const {
  // Tracks roll on the edges of the steps: the line through the edges starts one going before the first
  // riser.
  const double far_u = kLandingM + run_m();
  const double half_z = z_m + sizes_.flight_m();
  const double top_z = z_m + sizes_.storey_m();
  const double turn_u = far_u + 1.05;
  way.push_back({plan(kLandingM - sizes_.going_m - 0.5, 0.0), z_m, 0.6, "flat"});
  way.push_back({plan(kLandingM - sizes_.going_m, 0.0), z_m, speed_m_s, "stairs"});
  way.push_back({plan(far_u, 0.0), half_z, speed_m_s, "stairs"});
  way.push_back({plan(turn_u, 0.0), half_z, speed_m_s, "stairs"});
  way.push_back({plan(turn_u, kLaneGapM), half_z, speed_m_s, "stairs"});
  way.push_back({plan(far_u + sizes_.going_m, kLaneGapM), half_z, speed_m_s, "stairs"});
  way.push_back({plan(kLandingM, kLaneGapM), top_z, speed_m_s, "stairs"});
  way.push_back({plan(kLandingM - 0.5, kLaneGapM), top_z, speed_m_s, "stairs"});
  way.push_back({plan(kLandingM - 1.3, kLaneGapM), top_z, 0.5, "flat"});
  way.push_back({plan(kLandingM - 1.3, 0.0), top_z, 0.5, "flat"});
  way.push_back({plan(0.0, 0.0), top_z, 0.5, "flat"});
}

void Stairwell::route_down(std::vector<Waypoint>& way, double z_m, double speed_m_s) const {
  std::vector<Waypoint> up;
  route_up(up, z_m, speed_m_s);
  // Speed and label of a waypoint are those of the way towards it: in the reverse direction they move to the
  // next one.
  for (std::size_t i = up.size(); i-- > 0;) {
    Waypoint reversed = up[i];
    if (i + 1 < up.size()) {
      reversed.speed_m_s = up[i + 1].speed_m_s;
      reversed.label = up[i + 1].label;
    }
    way.push_back(reversed);
  }
}

}  // namespace isobar::simulation
