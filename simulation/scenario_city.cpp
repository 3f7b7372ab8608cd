// SPDX-License-Identifier: BSD-3-Clause
// Scenarios in the streets of a city: `city` (2 km), `city-10km` (a map much larger than the memory radius)
// and `city-hour` (20 km, for runs in real time).
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "simulation/city_block.hpp"
#include "simulation/city_route.hpp"
#include "simulation/city_traffic.hpp"
#include "simulation/scenario.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

/// Builds only the blocks within the lidar's range of the drive, so that memory grows with its length, not
/// with the area of the city.
Mesh build_blocks(const CityGrid& grid, const Terrain& terrain, const std::vector<RawPose>& poses,
                  std::uint64_t seed) {
  constexpr double kReachM = 105.0;
  std::set<std::pair<int, int>> blocks;
  constexpr std::size_t kEvery = 10;  // half a second: 5 m
  for (std::size_t i = 0; i < poses.size(); i += kEvery) {
    const Vector2d at(poses[i].x_m, poses[i].y_m);
    const Rect seen = Rect::around(at, at, kReachM);
    for (int x = 0; x + 1 < grid.columns(); ++x) {
      for (int y = 0; y + 1 < grid.rows(); ++y) {
        if (grid.cell({x, y}).overlaps(seen)) blocks.insert({x, y});
      }
    }
  }
  Mesh mesh;
  for (const auto& block : blocks) add_block(mesh, grid, terrain, {block.first, block.second}, seed);
  return mesh;
}

Scenario make(const char* name, std::uint64_t seed, const CityWayWish& wish) {
  Random random(seed, name);
  const Terrain terrain(Random(random.next()));
  const CityGrid grid(Random(random.next()), wish.columns + 2, rows_for(wish));
  const CityWay way = plan_city_way(grid, wish, random);
  const Route route = drive_city_way(grid, way, random);

  Scenario scenario;
  scenario.raw = route.samples();
  drape(scenario.raw, terrain);
  const double end_s = route.time_s();
  scenario.labels = {{0.0, end_s, "outdoor"}};
  std::vector<MovingBody> traffic = make_traffic(grid, terrain, way, scenario.raw, random);
  scenario.world = World(build_blocks(grid, terrain, scenario.raw, random.next()), std::move(traffic));
  // A sprung vehicle on asphalt: slightly more roll and pitch than tracks, much less yaw.
  add_shaking(scenario.raw, scenario.labels, Random(random.next()), {0.20, 0.20, 0.08, 0.003});
  scenario.trajectory = Trajectory(scenario.raw);
  scenario.tracked = false;
  scenario.mounts.lidar = {{0.35, 0.0, 1.75}, {0.0, 0.0, 0.0}};
  scenario.mounts.imu = {{0.0, 0.0, 0.50}, {0.0, 0.0, 0.0}};
  scenario.mounts.pressure_port_m = {-0.40, 0.10, 1.20};
  // One or two per cent of the dynamic pressure act on a port on the body, with either sign.
  scenario.air.port_coefficient = random.sign() * random.uniform(0.005, 0.025);
  scenario.air_temperature_c = random.uniform(2.0, 26.0);
  scenario.base_height_m = random.uniform(0.5, 6.0);
  scenario.start_pressure_pa = 101'325.0 + random.normal(900.0);
  return scenario;
}

constexpr CityWayWish kShort{3, 260.0, 0.0};

}  // namespace

Scenario make_city(std::uint64_t seed, bool short_form) {
  Scenario scenario = make("city", seed, short_form ? kShort : CityWayWish{6, 1'750.0, 250.0});
  scenario.description =
      short_form ? "city, short form: some streets" : "2 km of hilly streets, the last 250 m seen before";
  return scenario;
}

Scenario make_city_10km(std::uint64_t seed, bool short_form) {
  Scenario scenario = make("city-10km", seed, short_form ? kShort : CityWayWish{13, 9'000.0, 1'000.0});
  scenario.description = short_form ? "city-10km, short form: some streets"
                                    : "10 km of hilly streets, 9 km of them new, then back through old ones";
  return scenario;
}

Scenario make_city_hour(std::uint64_t seed, bool short_form) {
  Scenario scenario = make("city-hour", seed, short_form ? kShort : CityWayWish{20, 18'600.0, 1'000.0});
  scenario.description = short_form ? "city-hour, short form: some streets"
                                    : "an hour in hilly streets, 20 km, the last one seen before";
  return scenario;
}

}  // namespace isobar::simulation
