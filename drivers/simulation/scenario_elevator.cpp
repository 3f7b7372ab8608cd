// SPDX-License-Identifier: BSD-3-Clause
// `elevator`, the paper's second experiment: third floor, down to the ground floor with its ramp, and back.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/simulation/corridor.hpp"
#include "drivers/simulation/people.hpp"
#include "drivers/simulation/scenario.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kCabinWidthM = 1.7;
constexpr double kCabinDepthM = 2.1;
constexpr double kDoorWidthM = 1.1;
constexpr double kDoorHeightM = 2.1;
constexpr double kShaftDoorM = 0.25;  // thickness of the wall between corridor and shaft
constexpr double kDoorTimeS = 2.5;

/// When doors move and where the cabin is, on the time grid.
struct Lift {
  std::vector<double> cabin_z_m;
  std::vector<double> open;      ///< cabin doors: 0 shut … 1 open
  std::vector<double> open_top;  ///< landing doors
  std::vector<double> open_ground;
};

/// The cabin's inner walls, floor and ceiling, open at x = 0 towards -x; inside is 0 < x < depth.
Mesh make_cabin() {
  Mesh mesh;
  const double half = 0.5 * kCabinWidthM;
  const double top = 2.25;
  const double door = 0.5 * kDoorWidthM;
  const double x0 = 0.12;
  const double x1 = x0 + kCabinDepthM;
  const Surface metal = Surface::kMetal;
  mesh.quad({0.0, -half, 0.0}, {x1, -half, 0.0}, {x1, half, 0.0}, {0.0, half, 0.0}, Surface::kConcrete);
  mesh.quad({x0, -half, top}, {x1, -half, top}, {x1, half, top}, {x0, half, top}, Surface::kPlaster);
  mesh.quad({x1, -half, 0.0}, {x1, half, 0.0}, {x1, half, top}, {x1, -half, top}, metal);
  for (const double side : {-1.0, 1.0}) {
    mesh.quad({x0, side * half, 0.0}, {x1, side * half, 0.0}, {x1, side * half, top}, {x0, side * half, top},
              metal);
    mesh.quad({x0, side * door, 0.0}, {x0, side * half, 0.0}, {x0, side * half, top}, {x0, side * door, top},
              metal);
    // handrails
    mesh.box({x0 + 0.2, side * half, 0.85}, {x1 - 0.2, side * (half - 0.06), 0.92}, metal);
  }
  mesh.quad({x0, -door, kDoorHeightM}, {x0, door, kDoorHeightM}, {x0, door, top}, {x0, -door, top}, metal);
  return mesh;
}

/// One leaf of a sliding door; side -1 or +1, shut at its origin, overlapping the other by 2 cm.
Mesh make_leaf(double side) {
  Mesh mesh;
  mesh.box({-0.02, std::min(-side * 0.01, side * 0.5 * kDoorWidthM), 0.0},
           {0.02, std::max(-side * 0.01, side * 0.5 * kDoorWidthM), kDoorHeightM}, Surface::kMetal);
  return mesh;
}

/// A leaf of each side of a door at (x, y), sliding along y.
void add_doors(std::vector<MovingBody>& bodies, double x, double y, const std::vector<double>& open,
               const std::vector<double>& z) {
  for (const double side : {-1.0, 1.0}) {
    std::vector<double> slide;
    slide.reserve(open.size());
    for (const double fraction : open) slide.push_back(y + side * fraction * 0.5 * kDoorWidthM);
    bodies.push_back({RayCaster(make_leaf(side)), Channel(std::vector<double>(open.size(), x)),
                      Channel(std::move(slide)), Channel(z)});
  }
}

/// Corridor from the origin along +x; the elevator lies beyond its end.
struct Site {
  Corridor corridor;
  double end_x_m = 0.0;
  double height_m = 0.0;      ///< of the upper storey
  double ramp_start_m = 0.0;  ///< ground floor: going away from the elevator the floor rises here
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

/// Cuts the door's opening and, on the way, the shaft.
void cut_elevator(FloorPlan& plan, const Site& site, double storey_m) {
  const double half = 0.5 * kDoorWidthM;
  const double x = site.end_x_m;
  plan.cut({{x, -half, x + kShaftDoorM, half}, 0.0, kDoorHeightM});
  plan.cut({{x + kShaftDoorM, -1.0, x + kShaftDoorM + 2.5, 1.0}, 0.0, storey_m, false, false});
}

/// The ground floor beyond the ramp lies higher: the floor of the plan is cut there and closed by the ramp.
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
  // Opens the ramp towards the far part, which closes itself by its own plan.
  storey.plan.cut({{x0 - 1.0, -half, x0, half}, 0.0, near.ceiling_m, false, false, true});
  cut_elevator(storey.plan, site, site.height_m);
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
  cut_elevator(storey.plan, site, 2.6);
  storey.plan.build(mesh, site.height_m);
}

/// Drives the robot and the lift together.
class Timeline {
 public:
  Timeline(const Site& site, Random& random)
      : site_(site), route_({random.uniform(1.5, 2.5), 0.0}, site.height_m, 0.0), random_(random) {
    lift_.cabin_z_m.push_back(0.0);
    lift_.open.push_back(0.0);
    lift_.open_top.push_back(0.0);
    lift_.open_ground.push_back(0.0);
  }

  /// Waits for the lift at `top` or on the ground, drives in, turns round, and is carried to the other
  /// storey.
  void take_lift() {
    const bool top = route_.pose().z_m > 0.5 * site_.height_m;
    move_cabin_to(top ? site_.height_m : 0.0);
    doors(top, 1.0);
    const double middle_m = site_.end_x_m + kShaftDoorM + 0.12 + 0.5 * kCabinDepthM;
    drive({{{middle_m, 0.0}, route_.pose().z_m, 0.4, "flat"}});
    route_.turn(random_.sign() * std::numbers::pi);
    follow();
    doors(top, 0.0);
    const double before_m = route_.pose().z_m;
    const std::size_t first = route_.samples().size();
    route_.ride(top ? -site_.height_m : site_.height_m, ride_speed_m_s_, ride_acceleration_m_s2_);
    const double cabin_m = lift_.cabin_z_m.back();
    for (std::size_t i = first; i < route_.samples().size(); ++i) {
      push(cabin_m + route_.samples()[i].z_m - before_m);
    }
    doors(!top, 1.0);
  }

  void drive(const std::vector<Waypoint>& way) {
    route_.drive(way);
    follow();
  }
  void wait(double seconds) {
    route_.wait(seconds);
    follow();
  }
  void turn_round() {
    route_.turn(random_.sign() * std::numbers::pi);
    follow();
  }
  /// Opens (1) or shuts (0) the doors of the cabin and of one storey while the robot waits.
  void doors(bool top, double target) {
    const double from = lift_.open.back();
    for (double t = SplineGrid::kStepS; t <= kDoorTimeS; t += SplineGrid::kStepS) {
      const double phase = t / kDoorTimeS;
      const double fraction = from + (target - from) * 0.5 * (1.0 - std::cos(std::numbers::pi * phase));
      open_ = fraction;
      (top ? open_top_ : open_ground_) = fraction;
      wait(2.0 * SplineGrid::kStepS);
    }
    wait(random_.uniform(0.8, 1.5));
  }

  [[nodiscard]] const Route& route() const { return route_; }
  [[nodiscard]] const Lift& lift() const { return lift_; }

 private:
  /// The lift stands still while the robot moved.
  void follow() {
    while (lift_.cabin_z_m.size() < route_.samples().size()) push(lift_.cabin_z_m.back());
  }
  void push(double cabin_z_m) {
    lift_.cabin_z_m.push_back(cabin_z_m);
    lift_.open.push_back(open_);
    lift_.open_top.push_back(open_top_);
    lift_.open_ground.push_back(open_ground_);
  }
  /// The empty cabin comes, unseen behind shut doors.
  void move_cabin_to(double target_m) {
    const double from_m = lift_.cabin_z_m.back();
    const double seconds = std::abs(target_m - from_m) / ride_speed_m_s_;
    const auto steps = static_cast<int>(seconds / SplineGrid::kStepS);
    if (steps == 0) return;
    route_.wait(seconds + SplineGrid::kStepS);
    for (int i = 1; lift_.cabin_z_m.size() < route_.samples().size(); ++i) {
      push(from_m + (target_m - from_m) * std::min(1.0, static_cast<double>(i) / steps));
    }
  }

  const Site& site_;
  Route route_;
  Random& random_;
  Lift lift_;
  double open_ = 0.0;
  double open_top_ = 0.0;
  double open_ground_ = 0.0;
  // Passenger elevators: 1 m/s, up to 1 m/s^2.
  double ride_speed_m_s_ = 1.0;
  double ride_acceleration_m_s2_ = 0.8;
};

std::vector<MovingBody> lift_bodies(const Site& site, const Lift& lift) {
  std::vector<MovingBody> bodies;
  const std::size_t samples = lift.cabin_z_m.size();
  const double x = site.end_x_m + kShaftDoorM;
  const Channel cabin_z(lift.cabin_z_m);
  bodies.push_back({RayCaster(make_cabin()), Channel(std::vector<double>(samples, x)),
                    Channel(std::vector<double>(samples, 0.0)), cabin_z});
  add_doors(bodies, x + 0.08, 0.0, lift.open, lift.cabin_z_m);
  add_doors(bodies, site.end_x_m + 0.15, 0.0, lift.open_top, std::vector<double>(samples, site.height_m));
  add_doors(bodies, site.end_x_m + 0.15, 0.0, lift.open_ground, std::vector<double>(samples, 0.0));
  return bodies;
}

void drive_ground_floor(Timeline& timeline, const Site& site, bool short_form, Random& random) {
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

  Timeline timeline(site, random);
  const double speed = random.uniform(0.5, 0.7);
  timeline.wait(random.uniform(3.0, short_form ? 4.0 : 8.0));
  timeline.drive({{{site.end_x_m - 1.3, 0.0}, site.height_m, speed, "flat"}});
  timeline.take_lift();
  if (short_form) {
    timeline.drive({{{site.end_x_m - site.ramp_start_m, 0.0}, 0.0, speed, "flat"},
                    {{site.end_x_m - site.ramp_start_m - site.ramp_m, 0.0}, site.ramp_rise_m, 0.5, "ramp"},
                    {{1.5, 0.0}, site.ramp_rise_m, speed, "flat"}});
  } else {
    drive_ground_floor(timeline, site, short_form, random);
    timeline.take_lift();
    timeline.drive({{{random.uniform(2.0, 4.0), 0.0}, site.height_m, speed, "flat"}});
  }
  timeline.wait(2.0);

  Scenario scenario;
  scenario.description = "third floor and ground floor by elevator, with a ramp";
  scenario.raw = timeline.route().samples();
  scenario.labels = timeline.route().labels();
  add_shaking(scenario.raw, scenario.labels, Random(random.next()));
  scenario.trajectory = Trajectory(scenario.raw);
  std::vector<MovingBody> bodies = lift_bodies(site, timeline.lift());
  const int people = short_form ? 1 : 2;
  for (int i = 0; i < people; ++i) {
    Corridor walk = site.corridor;
    walk.corners_m.back().x() -= 2.0;
    bodies.push_back(make_walker(walk, 0, site.height_m, scenario.raw.size(), random));
  }
  scenario.world = World(mesh, std::move(bodies));
  scenario.air.door_pulses_1_s = 1.0 / random.uniform(40.0, 90.0);
  // A cabin is a loose piston: Pa a m/s, and it pushes the air of the shaft before it.
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
