// SPDX-License-Identifier: BSD-3-Clause
// `elevator`, the paper's second experiment: third floor, down to the ground floor with its ramp, and back.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/corridor.hpp"
#include "simulation/lift.hpp"
#include "simulation/people.hpp"
#include "simulation/scenario.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Dimensions of the building: a corridor from the origin along +x, with the elevator at its end.
struct Site {
  Corridor corridor;
  double end_x_m = 0.0;
  double height_m = 0.0;  ///< of the upper storey
  double ramp_start_m =
      0.0;  ///< distance from the elevator to the ramp on the ground floor, which rises away from it
  double ramp_m = 0.0;
  double ramp_rise_m = 0.0;
};

Site draw_site(Random& random, bool short_form) {
  Site site;
  site.corridor =
      draw_corridor(random, 1, short_form ? random.uniform(9.0, 11.0) : random.uniform(32.0, 40.0));
  site.end_x_m = site.corridor.corners_m.back().x();
  site.height_m = short_form ? random.uniform(3.4, 4.2) : random.uniform(10.0, 13.0);
  site.ramp_start_m = short_form ? 3.0 : random.uniform(8.0, 10.0);
  site.ramp_m = short_form ? 2.0 : random.uniform(4.0, 6.0);
  site.ramp_rise_m = site.ramp_m * random.uniform(0.06, 0.08);  // accessible ramps rise 6 to 8 %
  return site;
}

/// The elevator, with the ground floor and the upper storey.
LiftSite lift_of(const Site& site) { return {site.end_x_m, 0.0, {0.0, site.height_m}}; }

/// Ground floor: the part behind the ramp is a plan of its own at the height of the ramp's end; the ramp
/// replaces the floor between the two plans.
void build_ground(Mesh& mesh, const Site& site, Random& random) {
  Storey storey;
  const double x = site.end_x_m;
  storey.taken.push_back({x, -1.5, x + 4.0, 1.5});
  Corridor near = site.corridor;
  Corridor far = site.corridor;
  near.corners_m = {{x - site.ramp_start_m, 0.0}, {x, 0.0}};
  far.corners_m = {{0.0, 0.0}, {x - site.ramp_start_m - site.ramp_m, 0.0}};
  near.bare_leg = far.bare_leg = -1;
  add_corridor(near, storey, mesh, random);
  const double half = 0.5 * site.corridor.width_m;
  const double x0 = far.corners_m.back().x();
  const double x1 = near.corners_m.front().x();
  const double rise = site.ramp_rise_m;
  storey.plan.cut({{x0, -half, x1, half}, 0.0, near.ceiling_m + rise, false, true});
  // No wall between the ramp and the far part, which has its own plan.
  storey.plan.cut({{x0 - 1.0, -half, x0, half}, 0.0, near.ceiling_m, false, false, true});
  cut_shaft(storey.plan, lift_of(site), site.height_m);
  storey.plan.build(mesh, 0.0);
  mesh.quad({x0, -half, rise}, {x1, -half, 0.0}, {x1, half, 0.0}, {x0, half, rise}, Surface::kConcrete);
  Storey upper;
  upper.z_m = rise;
  upper.taken = storey.taken;
  add_corridor(far, upper, mesh, random);
  upper.plan.cut({{x0, -half, x1, half}, 0.0, far.ceiling_m, false, false, true});
  upper.plan.build(mesh, rise);
}

void build_top(Mesh& mesh, const Site& site, Random& random) {
  Storey storey;
  storey.z_m = site.height_m;
  const double x = site.end_x_m;
  storey.taken.push_back({x, -1.5, x + 4.0, 1.5});
  add_corridor(site.corridor, storey, mesh, random);
  cut_shaft(storey.plan, lift_of(site), 2.6);
  storey.plan.build(mesh, site.height_m);
}

void drive_ground_floor(LiftDrive& timeline, const Site& site, bool short_form, Random& random) {
  const double speed = random.uniform(0.5, 0.7);
  const double x1 = site.end_x_m - site.ramp_start_m;
  const double x0 = x1 - site.ramp_m;
  const double far_m = short_form ? x0 - 1.5 : random.uniform(3.0, 5.0);
  const double rise = site.ramp_rise_m;
  timeline.drive(
      {{{x1, 0.0}, 0.0, speed, "flat"}, {{x0, 0.0}, rise, 0.5, "ramp"}, {{far_m, 0.0}, rise, speed, "flat"}});
  timeline.turn_round();
  timeline.drive({{{x0, 0.0}, rise, speed, "flat"},
                  {{x1, 0.0}, 0.0, 0.5, "ramp"},
                  {{site.end_x_m - 1.3, 0.0}, 0.0, speed, "flat"}});
}

}  // namespace

Scenario make_elevator(std::uint64_t seed, bool short_form) {
  Random random(seed, "elevator");
  const Site site = draw_site(random, short_form);
  Mesh mesh;
  build_ground(mesh, site, random);
  build_top(mesh, site, random);

  LiftDrive timeline(lift_of(site), Route({random.uniform(1.5, 2.5), 0.0}, site.height_m, 0.0), random);
  const double speed = random.uniform(0.5, 0.7);
  timeline.wait(random.uniform(3.0, short_form ? 4.0 : 8.0));
  timeline.drive({{{site.end_x_m - 1.3, 0.0}, site.height_m, speed, "flat"}});
  timeline.take_lift(1, 0);
  if (short_form) {
    timeline.drive({{{site.end_x_m - site.ramp_start_m, 0.0}, 0.0, speed, "flat"},
                    {{site.end_x_m - site.ramp_start_m - site.ramp_m, 0.0}, site.ramp_rise_m, 0.5, "ramp"},
                    {{1.5, 0.0}, site.ramp_rise_m, speed, "flat"}});
  } else {
    drive_ground_floor(timeline, site, short_form, random);
    timeline.take_lift(0, 1);
    timeline.drive({{{random.uniform(2.0, 4.0), 0.0}, site.height_m, speed, "flat"}});
  }
  timeline.wait(2.0);

  Scenario scenario;
  scenario.description = "third floor and ground floor by elevator, with a ramp";
  scenario.raw = timeline.route().samples();
  scenario.labels = timeline.route().labels();
  add_shaking(scenario.raw, scenario.labels, Random(random.next()));
  scenario.trajectory = Trajectory(scenario.raw);
  std::vector<MovingBody> bodies = timeline.bodies();
  const int people = short_form ? 1 : 2;
  for (int i = 0; i < people; ++i) {
    Corridor walk = site.corridor;
    walk.corners_m.back().x() -= 2.0;
    bodies.push_back(make_walker(walk, 0, site.height_m, scenario.raw.size(), random));
  }
  scenario.world = World(mesh, std::move(bodies));
  scenario.air.door_pulses_1_s = 1.0 / random.uniform(40.0, 90.0);
  // Piston effect: the cabin is a loose piston in the shaft, with some Pa per m/s.
  scenario.air.piston_pa_s_m = random.uniform(0.3, 1.5);
  for (const RawPose& pose : scenario.raw) {
    const bool top = pose.z_m > 0.5 * site.height_m;
    const bool cabin = pose.x_m > site.end_x_m;
    scenario.air.zone.push_back(cabin ? 0 : top ? 1 : 2);
  }
  scenario.air_temperature_c = random.uniform(18.5, 24.0);
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

}  // namespace isobar::simulation
