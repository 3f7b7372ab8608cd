// SPDX-License-Identifier: BSD-3-Clause
// `corridor`: 300 m of bare walls, as in hospitals and tunnels of supply, without the base station for a while.
#include <algorithm>
#include <cmath>

#include "simulation/corridor.hpp"
#include "simulation/scenario.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

constexpr double kFurnishedM = 7.0;  // at both ends: rooms, cabinets, doors as in any corridor

/// Straight corridor, bare but for its ends and a door every 20 to 45 m.
Mesh build_corridor(const Corridor& corridor, Random& random) {
  Mesh mesh;
  Storey storey;
  add_corridor(corridor, storey, mesh, random);
  for (double s = corridor.bare_start_m + random.uniform(8.0, 20.0); s < corridor.bare_end_m - 3.0;
       s += random.uniform(20.0, 45.0)) {
    add_closed_door(corridor, 0, s, random.sign(), storey, mesh, random);
  }
  storey.plan.build(mesh, 0.0);
  return mesh;
}

Route drive_corridor(double length_m, Random& random) {
  Route route({1.5, 0.0}, 0.0, 0.0);
  route.wait(random.uniform(3.0, 8.0));
  const double speed = random.uniform(0.9, 1.1);
  std::vector<Waypoint> way;
  // The robot wanders by some centimetres around the centre line of the corridor.
  for (double x = 1.5 + random.uniform(3.5, 6.0); x < length_m - 6.0; x += random.uniform(3.5, 6.0)) {
    way.push_back({{x, random.uniform(-0.07, 0.07)}, 0.0, speed, "flat"});
  }
  way.push_back({{length_m - 1.5, 0.0}, 0.0, speed, "flat"});
  route.drive(way);
  route.wait(2.0);
  return route;
}

}  // namespace

Scenario make_corridor(std::uint64_t seed, bool short_form) {
  Random random(seed, "corridor");
  const double length_m = short_form ? 45.0 : 300.0;
  Corridor corridor = draw_corridor(random, 1, length_m);
  corridor.bare_leg = 0;
  corridor.bare_start_m = kFurnishedM;
  corridor.bare_end_m = length_m - kFurnishedM;

  Scenario scenario;
  scenario.description = short_form
                             ? "corridor, short form: 45 m, nearly featureless, 15 s without base station"
                             : "300 m of a nearly featureless corridor, 120 s without base station";
  scenario.world = World(build_corridor(corridor, random), {});
  const Route route = drive_corridor(length_m, random);
  scenario.raw = route.samples();
  scenario.labels = route.labels();
  add_shaking(scenario.raw, scenario.labels, Random(random.next()));
  scenario.trajectory = Trajectory(scenario.raw);
  const double middle_s = 0.5 * scenario.trajectory.duration_s();
  const double half_s = short_form ? 7.5 : 60.0;
  scenario.base_silent.push_back({middle_s - half_s, middle_s + half_s});
  for (const RawPose& pose : scenario.raw) {
    scenario.air.zone.push_back(static_cast<int>(3.0 * pose.x_m / length_m));
  }
  scenario.air.door_pulses_1_s = 1.0 / random.uniform(15.0, 30.0);
  scenario.air.pulses = PressureRange{1.0, 8.0};
  scenario.air_temperature_c = random.uniform(18.5, 24.0);
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

}  // namespace isobar::simulation
