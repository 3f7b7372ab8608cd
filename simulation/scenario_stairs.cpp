// SPDX-License-Identifier: BSD-3-Clause
// `stairs`: several storeys of one stairwell up and down, with a short level lobby on each.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/corridor.hpp"
#include "simulation/scenario.hpp"
#include "simulation/stairwell.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

/// Storeys with a lobby each, one above the other, joined by one stairwell.
class StairTower {
 public:
  /// `top`: number of the uppermost storey; the lowest is 0.
  StairTower(Random& random, int top)
      : top_(top),
        lobby_(draw_corridor(random, 1, random.uniform(5.5, 7.0))),
        well_{lobby_.corners_m.front(), Vector2d(-1.0, 0.0), random.sign(), StairSizes::draw(random, 9, 10)} {
    lobby_.ceiling_m = std::min(lobby_.ceiling_m, well_.sizes().storey_m() - 0.4);
    for (int i = 0; i <= top_; ++i) add_storey(i, random);
  }

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const Stairwell& well() const { return well_; }
  [[nodiscard]] double floor_m(int storey) const { return storey * well().sizes().storey_m(); }
  [[nodiscard]] double lobby_m() const { return lobby_.length_m(); }

 private:
  void add_storey(int index, Random& random) {
    Storey storey;
    storey.z_m = floor_m(index);
    storey.taken.push_back(well().rect().grown(0.3));
    add_corridor(lobby_, storey, mesh_, random);
    if (index == 0) {
      well().cut_lower(storey.plan);
    } else if (index == top_) {
      well().cut_upper(storey.plan, lobby_.ceiling_m);
    } else {
      well().cut_middle(storey.plan);
    }
    if (index < top_) well().build(mesh_, storey.z_m, index + 1 < top_);
    storey.plan.build(mesh_, storey.z_m);
  }

  int top_;
  Mesh mesh_;
  Corridor lobby_;
  Stairwell well_;
};

/// Into the lobby of a storey and back to the stairwell's entrance, where the next stairs begin.
void turn_in_lobby(Route& route, const StairTower& tower, int storey, Random& random) {
  const double depth_m = tower.lobby_m() - random.uniform(1.6, 2.2);
  route.drive({{{depth_m, random.uniform(-0.1, 0.1)}, tower.floor_m(storey), 0.6, "flat"}});
  route.wait(random.uniform(0.5, 2.0));
}

/// Ventilated zones: a lobby with its landing each, and the stairs between two storeys.
std::vector<int> stair_zones(const std::vector<RawPose>& raw, double storey_m) {
  std::vector<int> zones;
  zones.reserve(raw.size());
  for (const RawPose& pose : raw) {
    const double storeys = pose.z_m / storey_m;
    const double nearest = std::round(storeys);
    const bool on_floor = std::abs(storeys - nearest) * storey_m < 0.1;
    zones.push_back(on_floor ? 2 * static_cast<int>(nearest) : 2 * static_cast<int>(std::floor(storeys)) + 1);
  }
  return zones;
}

}  // namespace

Scenario make_stairs(std::uint64_t seed, bool short_form) {
  Random random(seed, "stairs");
  const int top = short_form ? 1 : 3;
  const StairTower tower(random, top);
  const double speed = random.uniform(0.28, 0.38);
  Route route({tower.lobby_m() - 2.0, 0.0}, 0.0, std::numbers::pi);
  route.wait(random.uniform(3.0, short_form ? 4.0 : 8.0));
  for (int storey = 0; storey < top; ++storey) {
    std::vector<Waypoint> way;
    tower.well().route_up(way, tower.floor_m(storey), speed);
    route.drive(way);
    turn_in_lobby(route, tower, storey + 1, random);
  }
  for (int storey = top - 1; storey >= 0 && !short_form; --storey) {
    std::vector<Waypoint> way;
    tower.well().route_down(way, tower.floor_m(storey), speed);
    route.drive(way);
    if (storey > 0) turn_in_lobby(route, tower, storey, random);
  }
  if (!short_form) route.drive({{{tower.lobby_m() - 2.0, 0.0}, 0.0, 0.6, "flat"}});
  route.wait(2.0);

  Scenario scenario;
  scenario.description = short_form ? "stairs, short form: one storey up"
                                    : "three storeys of stairs up and down again, with level lobbies";
  scenario.raw = route.samples();
  scenario.labels = route.labels();
  add_shaking(scenario.raw, scenario.labels, Random(random.next()));
  scenario.trajectory = Trajectory(scenario.raw);
  scenario.world = World(tower.mesh(), {});
  scenario.air.zone = stair_zones(scenario.raw, tower.well().sizes().storey_m());
  scenario.air.door_pulses_1_s = 1.0 / random.uniform(40.0, 90.0);
  scenario.air_temperature_c = random.uniform(18.5, 24.0);
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

}  // namespace isobar::simulation
