// SPDX-License-Identifier: BSD-3-Clause
// `hill`: a round of 600 m over open and wooded ground, in gusts of wind.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/hill_site.hpp"
#include "simulation/scenario.hpp"
#include "simulation/terrain.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

/// A wheeled robot of a metre's length on a meadow.
PlatformLimits rover_limits() {
  PlatformLimits limits;
  limits.acceleration_m_s2 = 0.6;
  limits.turn_rate_rad_s = 0.6;
  limits.corner_radius_m = 2.5;
  limits.bend_radius_m = 15.0;
  return limits;
}

/// Waypoints on an uneven oval from the origin back to it: legs of 10 to 16 m.
std::vector<Vector2d> draw_round(double length_m, Random& random) {
  // Circumference of an ellipse, Ramanujan 1914: pi (a + b) (1 + h / 4 + …), h below 0.12 here.
  const double flatness = random.uniform(0.5, 0.8);
  const double a_m = length_m / (std::numbers::pi * (1.0 + flatness) *
                                 (1.0 + 0.25 * std::pow((1.0 - flatness) / (1.0 + flatness), 2.0)));
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double side = random.sign();
  const auto on_oval = [&](double angle, double swell) {
    const Vector2d at(swell * a_m * std::cos(angle), swell * side * flatness * a_m * std::sin(angle));
    return Vector2d(std::cos(direction) * at.x() - std::sin(direction) * at.y(),
                    std::sin(direction) * at.x() + std::cos(direction) * at.y());
  };
  const Vector2d start = on_oval(0.0, 1.0);
  std::vector<Vector2d> way{Vector2d::Zero()};
  double angle = 0.0;
  GaussMarkov swell(0.04, 1.0, Random(random.next()));
  while (true) {
    const double local_m = a_m * std::hypot(std::sin(angle), flatness * std::cos(angle));
    angle += random.uniform(10.0, 16.0) / local_m;
    if (angle > 2.0 * std::numbers::pi - 8.0 / (flatness * a_m)) break;
    // The last third of the swell fades, so that the round closes.
    const double fade = std::min({1.0, angle, 2.0 * std::numbers::pi - angle});
    way.push_back(on_oval(angle, 1.0 + fade * swell.step(0.4)) - start);
  }
  way.emplace_back(Vector2d::Zero());
  return way;
}

Route drive_round(const std::vector<Vector2d>& round, Random& random) {
  const Vector2d first = round[1] - round[0];
  Route route(round.front(), 0.0, std::atan2(first.y(), first.x()), rover_limits());
  route.wait(random.uniform(3.0, 8.0));
  std::vector<Waypoint> way;
  double speed = random.uniform(1.2, 1.8);
  for (std::size_t i = 1; i < round.size(); ++i) {
    speed = std::clamp(speed + random.uniform(-0.3, 0.3), 1.0, 2.0);
    way.push_back({round[i], 0.0, speed, "outdoor"});
  }
  route.drive(way);
  route.wait(3.0);
  return route;
}

}  // namespace

Scenario make_hill(std::uint64_t seed, bool short_form) {
  Random random(seed, "hill");
  // Hills of 70 to 500 m with 12 m of relief; random waves rarely add up, so that slopes reach 10 to 15 %.
  const Terrain terrain(Random(random.next()), 0.20, 0.4);
  const Route route = drive_round(draw_round(short_form ? 75.0 : 600.0, random), random);

  Scenario scenario;
  scenario.description = short_form ? "hill, short form: a round of 75 m"
                                    : "a round of 600 m over a hill, without buildings, in gusts of wind";
  scenario.raw = route.samples();
  drape(scenario.raw, terrain);
  scenario.labels = {{0.0, route.time_s(), "outdoor"}};
  scenario.world = World(build_hill(terrain, scenario.raw, random.next()), {});
  // Soft tyres on grass and stones.
  add_shaking(scenario.raw, scenario.labels, Random(random.next()), {0.40, 0.40, 0.15, 0.004});
  scenario.trajectory = Trajectory(scenario.raw);
  scenario.tracked = false;
  scenario.mounts.lidar = {{0.20, 0.0, 0.95}, {0.0, 0.0, 0.0}};
  scenario.mounts.imu = {{0.0, 0.0, 0.30}, {0.0, 0.0, 0.0}};
  scenario.mounts.pressure_port_m = {-0.30, 0.10, 0.70};
  scenario.air.port_coefficient = random.sign() * random.uniform(0.005, 0.025);
  // A housing without a wind shield: 5 to 20 % of the dynamic pressure, with either sign.
  scenario.air.wind_m_s = random.uniform(3.0, 6.0);
  scenario.air.port_wind_share = random.sign() * random.uniform(0.05, 0.20);
  scenario.air.base_wind_share = random.sign() * random.uniform(0.05, 0.20);
  scenario.air_temperature_c = random.uniform(2.0, 26.0);
  scenario.base_height_m = random.uniform(0.5, 2.0);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

}  // namespace isobar::simulation
