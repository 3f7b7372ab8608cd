// SPDX-License-Identifier: BSD-3-Clause
// Plan and ground of the city, and the drive through it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "simulation/city_block.hpp"
#include "simulation/city_furniture.hpp"
#include "simulation/city_route.hpp"
#include "simulation/city_traffic.hpp"
#include "simulation/scenario.hpp"
#include "simulation/terrain.hpp"

namespace isobar::test::test_city {

using namespace isobar::simulation;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Key of a street of the grid, independent of the direction.
std::pair<std::pair<int, int>, std::pair<int, int>> street_of(const Crossing& a, const Crossing& b) {
  const std::pair p(a.x, a.y);
  const std::pair q(b.x, b.y);
  return p < q ? std::pair(p, q) : std::pair(q, p);
}

/// One full run, built once for all test cases.
const Scenario& whole_city() {
  static const Scenario scenario = make_city(1, false);
  return scenario;
}

double length_m(const Scenario& scenario) {
  double sum = 0.0;
  for (std::size_t i = 1; i < scenario.raw.size(); ++i) {
    sum += std::hypot(scenario.raw[i].x_m - scenario.raw[i - 1].x_m,
                      scenario.raw[i].y_m - scenario.raw[i - 1].y_m);
  }
  return sum;
}

/// Hit of a ray from a point of the robot's base_link.
Hit look(const Scenario& scenario, double time_s, const Vector3d& from_base, const Vector3d& direction_base) {
  const MotionState state = scenario.trajectory.at(time_s);
  const Vector3d eye = state.p_world + state.q_world_base * from_base;
  World::Moment moment;
  scenario.world.look(time_s, eye, 100.0, moment);
  return scenario.world.cast(moment, eye, state.q_world_base * direction_base, 100.0);
}

}  // namespace

TEST_CASE(
    "the terrain is 0 at the origin, never steeper than 6 %, and its slope is the derivative of its height") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    const Terrain terrain{Random(random.next())};
    CHECK(terrain.height_m(Vector2d::Zero()) == doctest::Approx(0.0));
    double steepest = 0.0;
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const Vector2d at(random.uniform(-1500.0, 1500.0), random.uniform(-1500.0, 1500.0));
      const Vector2d slope = terrain.slope(at);
      steepest = std::max(steepest, slope.norm());
      constexpr double kH = 0.01;
      const Vector2d dx(kH, 0.0);
      const Vector2d dy(0.0, kH);
      const Vector2d numeric(terrain.height_m(at + dx) - terrain.height_m(at - dx),
                             terrain.height_m(at + dy) - terrain.height_m(at - dy));
      worst = std::max(worst, (slope - numeric / (2.0 * kH)).norm());
    }
    CHECK(steepest <= Terrain::kSteepest);
    CHECK(steepest > 0.03);  // not flat
    CHECK(worst < 1e-8);     // h^2 times the third derivative: 1e-4 * 1e-5, plus rounding
  }
}

TEST_CASE(
    "a way of 10 km consists of adjacent crossings, uses new streets, and then returns to streets driven "
    "before") {
  const CityWayWish wish{13, 9'000.0, 1'000.0};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const CityGrid grid(Random(random.next()), wish.columns + 2, rows_for(wish));
    const CityWay way = plan_city_way(grid, wish, random);
    std::set<std::pair<std::pair<int, int>, std::pair<int, int>>> driven;
    double length = 0.0;
    int repeated_new = 0;
    int repeated_old = 0;
    for (std::size_t i = 0; i + 1 < way.crossings.size(); ++i) {
      const Crossing& a = way.crossings[i];
      const Crossing& b = way.crossings[i + 1];
      REQUIRE(std::abs(a.x - b.x) + std::abs(a.y - b.y) == 1);
      // Never on the border of the grid: there are blocks on both sides of every street.
      REQUIRE(b.x >= 1);
      REQUIRE(b.x <= grid.columns() - 2);
      REQUIRE(b.y >= 1);
      REQUIRE(b.y <= grid.rows() - 2);
      if (i > 0) CHECK_FALSE(way.crossings[i - 1] == b);  // never turns round
      const bool again = !driven.insert(street_of(a, b)).second;
      (i < way.first_old ? repeated_new : repeated_old) += again ? 1 : 0;
      length += (grid.at(b) - grid.at(a)).norm();
    }
    CHECK(repeated_new == 0);
    CHECK(repeated_old >= 3);
    CHECK(length >= 10'000.0);
    CHECK(length < 10'200.0);  // exceeded by at most two streets of 95 m
  }
}

TEST_CASE("a block does not depend on what else is built, and differs from its neighbour") {
  Random random(3);
  const Terrain terrain{Random(random.next())};
  const CityGrid grid(Random(random.next()), 5, 5);
  Mesh alone;
  add_block(alone, grid, terrain, {2, 1}, 77);
  Mesh both;
  add_block(both, grid, terrain, {1, 1}, 77);
  const std::size_t first = both.triangles().size();
  add_block(both, grid, terrain, {2, 1}, 77);
  REQUIRE(both.triangles().size() == first + alone.triangles().size());
  CHECK(first != alone.triangles().size());
  std::size_t differences = 0;
  for (std::size_t i = 0; i < alone.triangles().size(); ++i) {
    const Triangle& a = alone.triangles()[i];
    const Triangle& b = both.triangles()[first + i];
    if (a.a != b.a || a.b != b.b || a.c != b.c || a.surface != b.surface) ++differences;
  }
  CHECK(differences == 0);
}

TEST_CASE("seen from above, streets and pavements lie on the terrain and houses stand on it") {
  Random random(8);
  const Terrain terrain{Random(random.next())};
  const CityGrid grid(Random(random.next()), 4, 4);
  Mesh mesh;
  add_block(mesh, grid, terrain, {1, 1}, 5);
  const RayCaster caster(mesh);
  const Rect cell = grid.cell({1, 1});
  constexpr double kSkyM = 60.0;
  int on_ground = 0;
  int above = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector2d at(random.uniform(cell.x0, cell.x1), random.uniform(cell.y0, cell.y1));
    const Vector3d eye(at.x(), at.y(), terrain.height_m(at) + kSkyM);
    const Hit hit = caster.cast(eye.cast<float>(), -Eigen::Vector3f::UnitZ(), 100.0F);
    REQUIRE(hit.found);  // the ground has no holes
    const double height = kSkyM - static_cast<double>(hit.distance_m);
    // Flat patches of 4 m on terrain with a curvature below 1/1000 m: 2 mm; single precision adds a few
    // micrometres.
    CHECK(height > -0.002);
    const bool road = std::abs(height) < 0.002;
    const bool pavement = std::abs(height - kKerbM) < 0.002;
    if (road || pavement) ++on_ground;
    if (height > 3.0) ++above;
  }
  CHECK(on_ground > 800);
  CHECK(above > 400);
}

TEST_CASE("the city's vehicle stays on the ground and clear of all obstacles, parked and moving") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Scenario brief = seed == 1 ? Scenario{} : make_city(seed, true);
    const Scenario& scenario = seed == 1 ? whole_city() : brief;
    double least = 100.0;
    double lowest = 1.0;
    double highest = -1.0;
    double tilt = 0.0;
    for (double t = 0.0; t < scenario.trajectory.duration_s(); t += 0.4) {
      // At the height of a bonnet: lower objects such as kerbs may pass between the wheels.
      for (int i = 0; i < 16; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 16;
        const Hit hit = look(scenario, t, {0.0, 0.0, 0.9}, {std::cos(angle), std::sin(angle), 0.0});
        if (hit.found) least = std::min(least, static_cast<double>(hit.distance_m));
      }
      const double above =
          static_cast<double>(look(scenario, t, {0.0, 0.0, 0.5}, -Vector3d::UnitZ()).distance_m);
      lowest = std::min(lowest, above - 0.5);
      highest = std::max(highest, above - 0.5);
      // The ground is equally far below on the left and on the right: the vehicle rolls with the road.
      const double left =
          static_cast<double>(look(scenario, t, {0.0, 0.6, 0.5}, -Vector3d::UnitZ()).distance_m);
      const double right =
          static_cast<double>(look(scenario, t, {0.0, -0.6, 0.5}, -Vector3d::UnitZ()).distance_m);
      tilt = std::max(tilt, std::abs(left - right));
    }
    CHECK(least > 0.9);  // half of its width, 0.7 m, plus 0.2 m
    // Heave of 3 mm rms is 1.5 cm at five sigma; the inclination of the ray adds little.
    CHECK(lowest > -0.02);
    CHECK(highest < 0.02);
    // Vibration of the roll by 0.2 degrees rms: 4 mm over 1.2 m, 2.1 cm at five sigma.
    CHECK(tilt < 0.022);
  }
}

TEST_CASE(
    "city is 2 km of streets with several metres of height, driven at 6 to 10 m/s on straight stretches") {
  const Scenario& scenario = whole_city();
  CHECK(length_m(scenario) > 1'950.0);
  CHECK(length_m(scenario) < 2'250.0);
  double top_m_s = 0.0;
  double low_m = 0.0;
  double high_m = 0.0;
  double side_m_s2 = 0.0;
  for (double t = 0.0; t < scenario.trajectory.duration_s(); t += 0.1) {
    const MotionState state = scenario.trajectory.at(t);
    top_m_s = std::max(top_m_s, state.v_world.norm());
    low_m = std::min(low_m, state.p_world.z());
    high_m = std::max(high_m, state.p_world.z());
    const Vector3d a_base = state.q_world_base.conjugate() * state.a_world;
    side_m_s2 = std::max(side_m_s2, a_base.head<2>().norm());
  }
  CHECK(top_m_s > 7.0);
  CHECK(top_m_s < 10.1);
  CHECK(high_m - low_m > 4.0);
  CHECK(side_m_s2 < 3.0);  // corners at 2.4 m/s with a radius of 4 m: 1.4 m/s^2; braking: 1.8
}

TEST_CASE("traffic moves on the ground, exists while the robot is near, and on both sides of the way") {
  Random random(4);
  const CityWayWish wish{3, 400.0, 0.0};
  const Terrain terrain{Random(random.next())};
  const CityGrid grid(Random(random.next()), wish.columns + 2, rows_for(wish));
  const CityWay way = plan_city_way(grid, wish, random);
  std::vector<RawPose> poses = drive_city_way(grid, way, random).samples();
  drape(poses, terrain);
  const std::vector<MovingBody> traffic = make_traffic(grid, terrain, way, poses, random);
  REQUIRE(traffic.size() > 4);
  double fastest = 0.0;
  for (const MovingBody& body : traffic) {
    REQUIRE(body.first + body.x_m.size() <= poses.size());
    double least_m = 1e9;
    Vector2d before = Vector2d::Zero();
    for (std::size_t i = 0; i + 6 < body.x_m.size(); ++i) {
      const double t = SplineGrid::kStepS * static_cast<double>(i + 3);
      const Vector2d at(body.x_m.at(t), body.y_m.at(t));
      // On the carriageway, or 12 cm higher on the pavement.
      const double above = body.z_m.at(t) - terrain.height_m(at);
      CHECK(std::min(std::abs(above), std::abs(above - kKerbM)) < 0.002);
      const RawPose& robot = poses[body.first + i + 3];
      least_m = std::min(least_m, (at - Vector2d(robot.x_m, robot.y_m)).norm());
      if (i > 0) fastest = std::max(fastest, (at - before).norm() / SplineGrid::kStepS);
      before = at;
    }
    CHECK(least_m > 1.8);
    CHECK(least_m < 60.0);
  }
  CHECK(fastest > 4.0);
  CHECK(fastest < 12.0);
}

}  // namespace isobar::test::test_city
