// SPDX-License-Identifier: BSD-3-Clause
// `four-floors`: four storeys with the same plan, furniture included, joined by stairs and an elevator, driven many times:
// only the height tells them apart.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "simulation/corridor.hpp"
#include "simulation/corridor_walk.hpp"
#include "simulation/lift.hpp"
#include "simulation/people.hpp"
#include "simulation/scenario.hpp"
#include "simulation/stairwell.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

constexpr int kFloors = 4;
constexpr double kLongS = 2'400.0;  // 40 minutes

/// Four equal storeys: stairs at the beginning of the corridor, the elevator at its end.
class EqualFloors {
 public:
  EqualFloors(Random& random, int legs, double corridor_m, int steps_low, int steps_high)
      : corridor_(draw_corridor(random, legs, corridor_m)),
        well_(corridor_.corners_m.front(), Vector2d(-1.0, 0.0), random.sign(),
              StairSizes::draw(random, steps_low, steps_high)) {
    corridor_.ceiling_m = std::min(corridor_.ceiling_m, well_.sizes().storey_m() - 0.4);
    lift_ = {corridor_.corners_m.back().x(), corridor_.corners_m.back().y(), {}};
    for (int i = 0; i < kFloors; ++i) lift_.storeys_m.push_back(floor_m(i));
    const Random of_plan(random.next());
    for (int i = 0; i < kFloors; ++i) add_storey(i, of_plan);
  }

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const Corridor& corridor() const { return corridor_; }
  [[nodiscard]] const Stairwell& well() const { return well_; }
  [[nodiscard]] const LiftSite& lift() const { return lift_; }
  [[nodiscard]] double floor_m(int storey) const { return storey * well_.sizes().storey_m(); }
  [[nodiscard]] Vector2d before_lift_m() const { return corridor_.corners_m.back() - Vector2d(1.3, 0.0); }

 private:
  /// `random` is a copy: every storey draws the same numbers.
  void add_storey(int index, Random random) {
    Storey storey;
    storey.z_m = floor_m(index);
    storey.taken.push_back(well_.rect().grown(0.3));
    storey.taken.push_back({lift_.front_m, lift_.y_m - 1.5, lift_.front_m + 4.0, lift_.y_m + 1.5});
    add_corridor(corridor_, storey, mesh_, random);
    if (index == 0) {
      well_.cut_lower(storey.plan);
    } else if (index == kFloors - 1) {
      well_.cut_upper(storey.plan, corridor_.ceiling_m);
    } else {
      well_.cut_middle(storey.plan);
    }
    cut_shaft(storey.plan, lift_, index + 1 < kFloors ? well_.sizes().storey_m() : 2.6);
    if (index + 1 < kFloors) well_.build(mesh_, storey.z_m, index + 2 < kFloors);
    storey.plan.build(mesh_, storey.z_m);
  }

  Mesh mesh_;
  Corridor corridor_;
  Stairwell well_;
  LiftSite lift_;
};

/// Rounds of corridor, elevator, corridor, stairs.
class Rounds {
 public:
  Rounds(const EqualFloors& floors, Random& random)
      : floors_(floors),
        random_(random),
        drive_(floors.lift(), Route(floors.before_lift_m() - Vector2d(0.7, 0.0), 0.0, std::numbers::pi),
               random),
        stair_speed_m_s_(random.uniform(0.3, 0.38)) {}

  /// From the elevator to the stairs, to another storey, and to its elevator.
  void climb_to(int storey) {
    std::vector<Waypoint> way;
    walk(way, false);
    way.pop_back();  // the corridor's end, where the way of the stairs begins or passes
    if (storey > storey_) {
      floors_.well().route_up(way, floors_.floor_m(storey_), stair_speed_m_s_);
    } else {
      floors_.well().route_down(way, floors_.floor_m(storey), stair_speed_m_s_);
    }
    storey_ = storey;
    walk(way, true);
    drive_.drive(way);
  }
  void ride_to(int storey) {
    drive_.take_lift(static_cast<std::size_t>(storey_), static_cast<std::size_t>(storey));
    storey_ = storey;
  }
  /// From the elevator to the end of the corridor.
  void drive_to_stairs() {
    std::vector<Waypoint> way;
    walk(way, false);
    drive_.drive(way);
  }
  void wait(double low_s, double high_s) { drive_.wait(random_.uniform(low_s, high_s)); }
  [[nodiscard]] int storey() const { return storey_; }
  [[nodiscard]] const LiftDrive& drive() const { return drive_; }

 private:
  void walk(std::vector<Waypoint>& way, bool forwards) {
    constexpr double kBeforeLiftM = 1.3;
    append_walk(
        way, floors_.corridor(),
        {floors_.floor_m(storey_), forwards, forwards ? 0.0 : kBeforeLiftM, forwards ? kBeforeLiftM : 0.0},
        random_);
  }

  const EqualFloors& floors_;
  Random& random_;
  LiftDrive drive_;
  double stair_speed_m_s_;
  int storey_ = 0;
};

/// Another storey, each with equal probability.
int other_storey(int storey, Random& random) { return (storey + random.integer(1, kFloors - 1)) % kFloors; }

/// The next storey up or down.
int next_storey(int storey, Random& random) {
  if (storey == 0) return 1;
  if (storey == kFloors - 1) return kFloors - 2;
  return storey + (random.chance(0.5) ? 1 : -1);
}

void drive_long(Rounds& rounds, Random& random) {
  while (rounds.drive().route().time_s() < kLongS) {
    rounds.climb_to(next_storey(rounds.storey(), random));
    rounds.ride_to(other_storey(rounds.storey(), random));
  }
  rounds.drive_to_stairs();
}

void drive_short(Rounds& rounds) {
  rounds.climb_to(1);
  rounds.ride_to(3);
  rounds.climb_to(2);
  rounds.ride_to(0);
  rounds.drive_to_stairs();
}

/// Ventilated zones: each storey, the stairs, and the elevator.
std::vector<int> zones_of_floors(const std::vector<RawPose>& raw, const EqualFloors& floors) {
  const double storey_m = floors.well().sizes().storey_m();
  std::vector<int> zones;
  zones.reserve(raw.size());
  for (const RawPose& pose : raw) {
    const bool on_stairs = pose.x_m < floors.corridor().corners_m.front().x();
    const bool in_cabin = pose.x_m > floors.lift().front_m;
    const int storey = static_cast<int>(std::round(pose.z_m / storey_m));
    zones.push_back(in_cabin ? kFloors + 1 : on_stairs ? kFloors : storey);
  }
  return zones;
}

std::vector<MovingBody> people_on(const EqualFloors& floors, std::size_t samples, int a_storey,
                                  Random& random) {
  std::vector<MovingBody> people;
  const Corridor& corridor = floors.corridor();
  for (int storey = 0; storey < kFloors; ++storey) {
    for (int i = 0; i < a_storey; ++i) {
      const auto leg = static_cast<std::size_t>(random.integer(0, static_cast<int>(corridor.legs()) - 1));
      if (can_walk(corridor, leg)) {
        people.push_back(make_walker(corridor, leg, floors.floor_m(storey), samples, random));
      }
    }
  }
  return people;
}

}  // namespace

Scenario make_four_floors(std::uint64_t seed, bool short_form) {
  Random random(seed, "four-floors");
  const EqualFloors floors = short_form ? EqualFloors(random, 1, random.uniform(11.0, 13.0), 9, 10)
                                        : EqualFloors(random, 3, random.uniform(42.0, 48.0), 9, 10);
  Rounds rounds(floors, random);
  rounds.wait(3.0, 5.0);
  if (short_form) {
    drive_short(rounds);
  } else {
    drive_long(rounds, random);
  }
  rounds.wait(2.0, 2.0);

  Scenario scenario;
  scenario.description = short_form ? "four floors of equal plan, each driven once"
                                    : "four floors of equal plan, driven for 40 minutes";
  scenario.raw = rounds.drive().route().samples();
  scenario.labels = rounds.drive().route().labels();
  add_shaking(scenario.raw, scenario.labels, Random(random.next()));
  scenario.trajectory = Trajectory(scenario.raw);
  std::vector<MovingBody> bodies = rounds.drive().bodies();
  std::vector<MovingBody> people = people_on(floors, scenario.raw.size(), short_form ? 0 : 2, random);
  std::move(people.begin(), people.end(), std::back_inserter(bodies));
  scenario.world = World(floors.mesh(), std::move(bodies));
  scenario.air.zone = zones_of_floors(scenario.raw, floors);
  scenario.air.door_pulses_1_s = 1.0 / random.uniform(40.0, 90.0);
  scenario.air.piston_pa_s_m = random.uniform(0.3, 1.5);
  scenario.air_temperature_c = random.uniform(18.5, 24.0);
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

}  // namespace isobar::simulation
