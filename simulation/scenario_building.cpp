// SPDX-License-Identifier: BSD-3-Clause
// Scenarios on stairs: `three-floors`, the paper's first experiment, and `stairs-demo`.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/corridor.hpp"
#include "simulation/corridor_walk.hpp"
#include "simulation/people.hpp"
#include "simulation/scenario.hpp"
#include "simulation/stairwell.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

/// Storeys with the same corridor. The stairwell at its beginning joins storeys 0 and 1, the one at its end
/// joins storeys 1 and 2.
class Building {
 public:
  Building(Random& random, int storeys, int legs, double corridor_m, int steps_low, int steps_high)
      : corridor_(draw_corridor(random, legs, corridor_m)) {
    const StairSizes sizes = StairSizes::draw(random, steps_low, steps_high);
    corridor_.ceiling_m = std::min(corridor_.ceiling_m, sizes.storey_m() - 0.4);
    wells_.emplace_back(corridor_.corners_m.front(), Vector2d(-1.0, 0.0), random.sign(), sizes);
    if (storeys > 2) {
      wells_.emplace_back(corridor_.corners_m.back(), Vector2d(1.0, 0.0), random.sign(), sizes);
    }
    for (int i = 0; i < storeys; ++i) add_storey(i, random);
  }

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const Corridor& corridor() const { return corridor_; }
  [[nodiscard]] const Stairwell& well(int storey) const { return wells_[static_cast<std::size_t>(storey)]; }
  [[nodiscard]] double floor_m(int storey) const { return storey * wells_.front().sizes().storey_m(); }

  void walk(std::vector<Waypoint>& way, int storey, bool forwards, double skip_first_m, double skip_last_m,
            Random& random) const {
    append_walk(way, corridor_, {floor_m(storey), forwards, skip_first_m, skip_last_m}, random);
  }

 private:
  void add_storey(int index, Random& random) {
    Storey storey;
    storey.z_m = floor_m(index);
    for (const Stairwell& well : wells_) storey.taken.push_back(well.rect().grown(0.3));
    add_corridor(corridor_, storey, mesh_, random);
    // Well w joins storeys w and w + 1.
    for (int w = 0; w < static_cast<int>(wells_.size()); ++w) {
      if (w == index) {
        well(w).cut_lower(storey.plan);
        well(w).build(mesh_, storey.z_m);
      } else if (w + 1 == index) {
        well(w).cut_upper(storey.plan, corridor_.ceiling_m);
      }
    }
    storey.plan.build(mesh_, storey.z_m);
  }

  Mesh mesh_;
  Corridor corridor_;
  std::vector<Stairwell> wells_;
};

/// Index after the first waypoint from `from` on that is suitable for a stop: on a flat and nearly straight
/// stretch.
std::ptrdiff_t find_stop(const std::vector<Waypoint>& way, std::size_t from) {
  for (std::size_t i = from; i + 1 < way.size(); ++i) {
    const Vector2d before = (way[i].xy_m - way[i - 1].xy_m).normalized();
    const Vector2d after = (way[i + 1].xy_m - way[i].xy_m).normalized();
    if (way[i].label == "flat" && way[i + 1].label == "flat" && before.dot(after) > 0.99) {
      return static_cast<std::ptrdiff_t>(i + 1);
    }
  }
  return static_cast<std::ptrdiff_t>(way.size());
}

/// Ventilated zones: the two halves of each storey, and each staircase.
std::vector<int> zones_of(const std::vector<RawPose>& raw, const std::vector<LabelledSpan>& labels,
                          double middle_x_m) {
  std::vector<int> zones;
  std::size_t span = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    while (span + 1 < labels.size() && SplineGrid::kStepS * static_cast<double>(i) > labels[span].end_s) {
      ++span;
    }
    const int half = raw[i].x_m > middle_x_m ? 1 : 0;
    zones.push_back(3 * static_cast<int>(span) + (labels[span].label == "flat" ? half : 2));
  }
  return zones;
}

void finish(Scenario& scenario, const Building& building, const Route& route, int storeys,
            double people_a_storey, Random& random) {
  scenario.raw = route.samples();
  scenario.labels = route.labels();
  add_shaking(scenario.raw, scenario.labels, Random(random.next()));
  scenario.trajectory = Trajectory(scenario.raw);
  const Corridor& corridor = building.corridor();
  const double middle_x_m = 0.5 * (corridor.corners_m.front().x() + corridor.corners_m.back().x());
  scenario.air.zone = zones_of(scenario.raw, scenario.labels, middle_x_m);
  scenario.air.door_pulses_1_s = 1.0 / random.uniform(40.0, 90.0);
  std::vector<MovingBody> people;
  for (int storey = 0; storey < storeys; ++storey) {
    const int count = static_cast<int>(people_a_storey + random.uniform());
    for (int i = 0; i < count; ++i) {
      const auto leg = static_cast<std::size_t>(random.integer(0, static_cast<int>(corridor.legs()) - 1));
      if (!can_walk(corridor, leg)) continue;
      people.push_back(make_walker(corridor, leg, building.floor_m(storey), scenario.raw.size(), random));
    }
  }
  scenario.world = World(building.mesh(), std::move(people));
  scenario.air_temperature_c = random.uniform(18.5, 24.0);
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
}

}  // namespace

Scenario make_three_floors(std::uint64_t seed, bool short_form) {
  Random random(seed, "three-floors");
  Scenario scenario;
  const double stair_speed = random.uniform(0.28, 0.38);
  if (short_form) {
    const Building building(random, 2, 1, random.uniform(13.0, 16.0), 9, 10);
    Route route({building.corridor().corners_m.back().x() - 2.0, 0.0}, 0.0, std::numbers::pi);
    route.wait(random.uniform(3.0, 4.0));
    std::vector<Waypoint> way;
    building.walk(way, 0, false, 2.0, 0.0, random);
    building.well(0).route_up(way, 0.0, stair_speed);
    building.walk(way, 1, true, 0.0, 2.0, random);
    route.drive(way);
    route.wait(1.5);
    scenario.description = "three-floors, short form: two floors, one staircase";
    finish(scenario, building, route, 2, 1.0, random);
    return scenario;
  }
  const Building building(random, 3, 5, random.uniform(100.0, 105.0), 17, 18);
  const Corridor& corridor = building.corridor();
  Route route(corridor.corners_m.back() - Vector2d(2.0, 0.0), 0.0, std::numbers::pi);
  route.wait(random.uniform(3.0, 8.0));
  std::vector<Waypoint> way;
  building.walk(way, 0, false, 2.0, 0.0, random);
  building.well(0).route_up(way, building.floor_m(0), stair_speed);
  building.walk(way, 1, true, 0.0, 0.0, random);
  building.well(1).route_up(way, building.floor_m(1), stair_speed);
  building.walk(way, 2, false, 0.0, 2.0, random);
  // Two short stops on the way, as an operator makes them.
  const auto first_stop = way.begin() + find_stop(way, way.size() / 4);
  const auto second_stop = way.begin() + find_stop(way, 3 * way.size() / 4);
  route.drive({way.begin(), first_stop});
  route.wait(random.uniform(1.0, 4.0));
  route.drive({first_stop, second_stop});
  route.wait(random.uniform(1.0, 4.0));
  route.drive({second_stop, way.end()});
  route.wait(3.0);
  scenario.description = "three floors, two staircases, about 311 m of corridors and 12 m of height";
  finish(scenario, building, route, 3, 3.0, random);
  return scenario;
}

Scenario make_round_trip(std::uint64_t seed, bool short_form) {
  Random random(seed, "round-trip");
  Scenario scenario;
  const int top = short_form ? 1 : 2;
  const Building building(random, top + 1, short_form ? 1 : 5,
                          short_form ? random.uniform(22.0, 26.0) : random.uniform(70.0, 76.0), 17, 18);
  const double stair_speed = random.uniform(0.28, 0.38);
  Route route(building.corridor().corners_m.back() - Vector2d(2.0, 0.0), 0.0, std::numbers::pi);
  route.wait(random.uniform(3.0, 5.0));
  std::vector<Waypoint> way;
  building.walk(way, 0, false, 2.0, 0.0, random);
  building.well(0).route_up(way, building.floor_m(0), stair_speed);
  building.walk(way, 1, true, 0.0, top == 1 ? 2.0 : 0.0, random);
  if (top == 2) {
    building.well(1).route_up(way, building.floor_m(1), stair_speed);
    building.walk(way, 2, false, 0.0, 2.0, random);
  }
  route.drive(way);
  route.wait(random.uniform(1.0, 3.0));
  way.clear();
  if (top == 2) {
    building.walk(way, 2, true, 2.0, 0.0, random);
    building.well(1).route_down(way, building.floor_m(1), stair_speed);
  }
  building.walk(way, 1, false, top == 1 ? 2.0 : 0.0, 0.0, random);
  building.well(0).route_down(way, building.floor_m(0), stair_speed);
  building.walk(way, 0, true, 0.0, 2.0, random);
  route.drive(way);
  route.wait(3.0);
  scenario.description = short_form ? "round-trip, short form: two floors, up and back to the start"
                                    : "three floors, up two staircases and back the same way to the start";
  finish(scenario, building, route, top + 1, short_form ? 1.0 : 3.0, random);
  return scenario;
}

Scenario make_stairs_demo(std::uint64_t seed, bool short_form) {
  Random random(seed, "stairs-demo");
  Scenario scenario;
  const double length = short_form ? random.uniform(9.0, 10.0) : random.uniform(14.0, 17.0);
  const Building building(random, 2, short_form ? 1 : 3, length, 9, 10);
  const Vector2d end = building.corridor().corners_m.back();
  Route route(end - Vector2d(1.5, 0.0), building.floor_m(1), std::numbers::pi);
  route.wait(random.uniform(3.0, 4.0));
  std::vector<Waypoint> way;
  building.walk(way, 1, false, 1.5, 0.0, random);
  building.well(0).route_down(way, 0.0, random.uniform(0.32, 0.38));
  building.walk(way, 0, true, 0.0, 1.5, random);
  route.drive(way);
  route.wait(1.5);
  scenario.description = "a corridor, down a staircase to the next floor and on";
  finish(scenario, building, route, 2, 1.0, random);
  return scenario;
}

}  // namespace isobar::simulation
