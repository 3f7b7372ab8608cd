// SPDX-License-Identifier: BSD-3-Clause
// `parking`: up the helical ramp of a parking garage, from the lowest deck to the roof.
#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/parking_site.hpp"
#include "simulation/scenario.hpp"

namespace isobar::simulation {

namespace {

constexpr double kLaneOnDeckM = 4.0;  // distance of the robot's way on a deck from the deck's middle line
constexpr double kPiece = std::numbers::pi / 12.0;  // 15 degrees of the ramp a waypoint

/// A wheeled robot; its way up the ramp is a polygon whose corners are arcs nearly as wide as the ramp.
PlatformLimits limits_on(const ParkingSizes& sizes) {
  PlatformLimits limits;
  limits.corner_radius_m = 2.5;
  limits.bend_radius_m = 0.95 * sizes.radius_m;
  return limits;
}

/// Appends the way up the ramp: the polygon around the lane's centre line.
void climb(const ParkingSizes& sizes, double speed_m_s, std::vector<Waypoint>& way) {
  const double corner_m = sizes.radius_m / std::cos(0.5 * kPiece);
  const int pieces = 24 * sizes.top;
  for (int i = 0; i < pieces; ++i) {
    const double angle = (i + 0.5) * kPiece;
    const double z_m = sizes.lane_m(angle);
    const bool level = i == 0 || std::abs(z_m - way.back().z_m) < 1e-6;
    way.push_back(
        {{corner_m * std::cos(angle), corner_m * std::sin(angle)}, z_m, speed_m_s, level ? "flat" : "ramp"});
  }
}

Route drive_up(const ParkingSizes& sizes, bool short_form, Random& random) {
  const double far_m = sizes.deck_start_m() + (short_form ? 9.0 : sizes.deck_m - 5.0);
  Route route({far_m, -kLaneOnDeckM}, 0.0, std::numbers::pi, limits_on(sizes));
  route.wait(random.uniform(3.0, short_form ? 4.0 : 8.0));
  const double speed = short_form ? random.uniform(1.3, 1.5) : random.uniform(1.0, 1.5);
  const double top_m = sizes.storey_m * sizes.top;
  std::vector<Waypoint> way{{{sizes.radius_m, -kLaneOnDeckM}, 0.0, speed, "flat"}};
  climb(sizes, speed, way);
  way.push_back({{sizes.radius_m, kLaneOnDeckM}, top_m, speed, "flat"});
  way.push_back({{far_m, kLaneOnDeckM}, top_m, speed, "flat"});
  if (!short_form) {
    way.push_back({{far_m, -kLaneOnDeckM}, top_m, speed, "flat"});
    way.push_back({{sizes.deck_start_m() + 5.0, -kLaneOnDeckM}, top_m, speed, "flat"});
  }
  route.drive(way);
  route.wait(3.0);
  return route;
}

}  // namespace

Scenario make_parking(std::uint64_t seed, bool short_form) {
  Random random(seed, "parking");
  const ParkingSizes sizes = ParkingSizes::draw(random, short_form ? 1 : random.integer(3, 4));
  const Route route = drive_up(sizes, short_form, random);

  Scenario scenario;
  scenario.description = short_form ? "parking, short form: one turn of the ramp"
                                    : "up the helical ramp of a parking garage to its roof, with level decks";
  scenario.raw = route.samples();
  scenario.labels = route.labels();
  scenario.world = World(build_parking(sizes, random), {});
  add_shaking(scenario.raw, scenario.labels, Random(random.next()), {0.15, 0.15, 0.10, 0.001});
  scenario.trajectory = Trajectory(scenario.raw);
  scenario.tracked = false;
  scenario.air.port_coefficient = random.sign() * random.uniform(0.005, 0.025);
  scenario.air.wind_m_s = random.uniform(0.8, 2.0);  // between open sides
  scenario.air.port_wind_share = random.sign() * random.uniform(0.05, 0.20);
  scenario.air.base_wind_share = random.sign() * random.uniform(0.05, 0.20);
  scenario.air_temperature_c = random.uniform(2.0, 26.0);
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

}  // namespace isobar::simulation
