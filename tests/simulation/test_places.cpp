// SPDX-License-Identifier: BSD-3-Clause
// The places of issue 11: hill, parking garage, stairwell, long corridor.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "simulation/hill_site.hpp"
#include "simulation/parking_site.hpp"
#include "simulation/scenario.hpp"
#include "simulation/terrain.hpp"

namespace isobar::test::test_places {

using namespace isobar::simulation;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kRangeM = 100.0;  // of the lidar

/// Distance to the nearest surface from a point of base_link; kRangeM: none.
double look(const Scenario& scenario, double time_s, const Vector3d& from_base,
            const Vector3d& direction_base) {
  const MotionState state = scenario.trajectory.at(time_s);
  const Vector3d eye = state.p_world + state.q_world_base * from_base;
  World::Moment moment;
  scenario.world.look(time_s, eye, kRangeM, moment);
  return scenario.world.cast(moment, eye, state.q_world_base * direction_base, kRangeM).distance_m;
}

/// What a run is made of.
struct Run {
  double travelled_m = 0.0;
  double lowest_m = 0.0;
  double highest_m = 0.0;
  double steepest = 0.0;
  double fastest_m_s = 0.0;
};

Run measure(const Scenario& scenario) {
  Run run;
  for (double t = 0.0; t < scenario.trajectory.duration_s(); t += 0.05) {
    const MotionState state = scenario.trajectory.at(t);
    run.travelled_m += 0.05 * state.v_world.norm();
    run.lowest_m = std::min(run.lowest_m, state.p_world.z());
    run.highest_m = std::max(run.highest_m, state.p_world.z());
    const Vector3d forward = state.q_world_base * Vector3d::UnitX();
    run.steepest = std::max(run.steepest, std::abs(forward.z()) / forward.head<2>().norm());
    run.fastest_m_s = std::max(run.fastest_m_s, state.v_world.norm());
  }
  return run;
}

/// Share of the beams of a VLP-16 that hit something, at 20 times of the run.
double share_of_returns(const Scenario& scenario) {
  int hits = 0;
  int beams = 0;
  for (int at = 0; at < 20; ++at) {
    for (int azimuth = 0; azimuth < 36; ++azimuth) {
      for (int elevation_deg = -15; elevation_deg <= 15; elevation_deg += 6) {
        const double a = std::numbers::pi / 18.0 * azimuth;
        const double e = std::numbers::pi / 180.0 * elevation_deg;
        const Vector3d beam(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        ++beams;
        const double time_s = scenario.trajectory.duration_s() * (at + 0.5) / 20.0;
        if (look(scenario, time_s, scenario.mounts.lidar.xyz_m, beam) < kRangeM) ++hits;
      }
    }
  }
  return static_cast<double>(hits) / beams;
}

}  // namespace

TEST_CASE(
    "hill is a closed round of 600 m at 1 to 2 m/s with several metres of relief and slopes of 8 to 20 %") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = make_hill(seed, false);
    const Run run = measure(scenario);
    CHECK(run.travelled_m > 540.0);
    CHECK(run.travelled_m < 680.0);
    CHECK(run.fastest_m_s < 2.2);
    CHECK(run.highest_m - run.lowest_m > 4.0);
    CHECK(run.steepest > 0.08);
    CHECK(run.steepest < 0.23);  // the bound of the terrain, and shaking of 0.4 degrees at four sigma
    const Vector3d start = scenario.trajectory.at(0.0).p_world;
    const Vector3d end = scenario.trajectory.at(scenario.trajectory.duration_s()).p_world;
    CHECK((end - start).norm() < 0.1);
    CHECK(share_of_returns(scenario) > 0.3);
    CHECK(share_of_returns(scenario) < 0.9);  // the sky is open
  }
}

TEST_CASE("the rover on the hill stays on the ground and clear of trunks, bushes and rocks") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = make_hill(seed, seed > 1);
    double least = kRangeM;
    double off = 0.0;
    for (double t = 0.0; t < scenario.trajectory.duration_s(); t += 0.2) {
      for (int i = 0; i < 16; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 16;
        // Level in the world, not in the robot: on a slope the ground is ahead.
        const MotionState state = scenario.trajectory.at(t);
        const Vector3d level =
            state.q_world_base.conjugate() * Vector3d(std::cos(angle), std::sin(angle), 0.12);
        least = std::min(least, look(scenario, t, {0.0, 0.0, 0.6}, level.normalized()));
      }
      const double above = look(scenario, t, {0.0, 0.0, 0.5}, -Vector3d::UnitZ()) - 0.5;
      off = std::max(off, std::abs(above));
    }
    CHECK(least > 0.6);  // half of the robot's width and 0.2 m
    // Uneven ground of 1.5 cm, heave of 4 mm, cells of 2 m on hills of 70 m: six sigma of the first.
    CHECK(off < 0.10);
  }
}

TEST_CASE("each patch of the hill depends on its place only: a longer way adds ground and changes none") {
  const Terrain terrain(Random(3), 0.20, 0.4);
  std::vector<RawPose> way(40);
  for (std::size_t i = 0; i < way.size(); ++i) way[i].x_m = 0.1 * static_cast<double>(i);
  const Mesh first = build_hill(terrain, way, 9);
  for (int i = 0; i < 200; ++i) way.push_back({way.back().x_m + 0.1, 0.0, 0.0, 0.0, 0.0, 0.0});
  const Mesh second = build_hill(terrain, way, 9);
  CHECK(second.triangles().size() > first.triangles().size());
  const RayCaster small(first);
  const RayCaster large(second);
  Random random(4);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {  // seen from above, away from the longer way
    const Eigen::Vector3f eye(static_cast<float>(random.uniform(-90.0, -5.0)),
                              static_cast<float>(random.uniform(-40.0, 40.0)), 60.0F);
    const Hit a = small.cast(eye, -Eigen::Vector3f::UnitZ(), 120.0F);
    const Hit b = large.cast(eye, -Eigen::Vector3f::UnitZ(), 120.0F);
    if (!a.found) continue;
    ++compared;
    CHECK(std::abs(a.distance_m - b.distance_m) <
          1e-3F);  // single precision at 60 m, other order of triangles
  }
  CHECK(compared > 300);
}

TEST_CASE("the hill is windy, at both ports") {
  const Scenario scenario = make_hill(1, true);
  CHECK(scenario.air.wind_m_s > 2.0);
  CHECK(std::abs(scenario.air.port_wind_share) >= 0.05);
  CHECK(std::abs(scenario.air.base_wind_share) >= 0.05);
}

TEST_CASE("parking climbs a full storey a turn, level at each deck, at the lane's slope between") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = make_parking(seed, false);
    const Run run = measure(scenario);
    const double end_m = scenario.trajectory.at(scenario.trajectory.duration_s()).p_world.z();
    const double storeys = end_m / 3.0;  // of 2.8 to 3.2 m
    CHECK(storeys > 2.7);
    CHECK(storeys < 4.4);
    CHECK(run.steepest > 0.04);
    CHECK(run.steepest < 0.11);
    std::set<int> levels;
    for (const LabelledSpan& span : scenario.labels) {
      if (span.label != "flat") continue;
      const double from_m = scenario.trajectory.at(span.start_s + 1.0).p_world.z();
      const double to_m = scenario.trajectory.at(span.end_s - 1.0).p_world.z();
      CHECK(std::abs(to_m - from_m) < 0.03);
      levels.insert(static_cast<int>(std::lround(from_m / 3.0)));
    }
    CHECK(levels.size() == static_cast<std::size_t>(std::lround(storeys)) + 1);
    CHECK(share_of_returns(scenario) > 0.6);
  }
}

TEST_CASE("the lane of the garage is continuous, level at the decks and rises by one storey a turn") {
  ParkingSizes sizes;
  for (const double turn : {0.0, 1.0, 2.0}) {
    const double full = 2.0 * std::numbers::pi * turn;
    CHECK(sizes.lane_m(full) == doctest::Approx(turn * sizes.storey_m));
    CHECK(sizes.lane_m(full + ParkingSizes::kFlatRad - 1e-9) == doctest::Approx(turn * sizes.storey_m));
    CHECK(sizes.lane_m(full - ParkingSizes::kFlatRad + 1e-9) == doctest::Approx(turn * sizes.storey_m));
    CHECK(sizes.lane_m(full - ParkingSizes::kFlatRad - 1e-9) == doctest::Approx(turn * sizes.storey_m));
    CHECK(sizes.lane_m(full + std::numbers::pi) == doctest::Approx((turn + 0.5) * sizes.storey_m));
  }
}

TEST_CASE("stairs go three storeys up and the same down again, over twelve flights of one stairwell") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = make_stairs(seed, false);
    const Run run = measure(scenario);
    CHECK(run.highest_m > 8.5);
    CHECK(run.highest_m < 11.0);
    const double end_m = scenario.trajectory.at(scenario.trajectory.duration_s()).p_world.z();
    CHECK(std::abs(end_m) < 1e-6);
    CHECK(std::count_if(scenario.labels.begin(), scenario.labels.end(),
                        [](const LabelledSpan& span) { return span.label == "stairs"; }) == 6);
    CHECK(run.steepest > 0.5);
    CHECK(share_of_returns(scenario) > 0.9);  // indoors
  }
}

TEST_CASE("corridor is 300 m of walls, bare between its ends, without base station for 120 s in the middle") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = make_corridor(seed, false);
    const Run run = measure(scenario);
    CHECK(run.travelled_m > 295.0);
    CHECK(run.travelled_m < 300.0);
    REQUIRE(scenario.base_silent.size() == 1);
    const TimeSpan silent = scenario.base_silent.front();
    CHECK(silent.end_s - silent.start_s == doctest::Approx(120.0));
    CHECK(silent.start_s > 50.0);
    CHECK(scenario.trajectory.duration_s() - silent.end_s > 50.0);
    REQUIRE(scenario.air.pulses);
    CHECK(scenario.air.pulses->low_pa == doctest::Approx(1.0));
    CHECK(scenario.air.pulses->high_pa == doctest::Approx(8.0));
    // Across, the walls are equally far everywhere but at doors: niches of 6 to 19 cm, frames of 3 cm.
    int even = 0;
    int rays = 0;
    for (double t = 30.0; t < scenario.trajectory.duration_s() - 30.0; t += 0.5) {
      const MotionState state = scenario.trajectory.at(t);
      const Vector3d left = state.q_world_base.conjugate() * Vector3d::UnitY();
      const double width =
          look(scenario, t, {0.0, 0.0, 0.5}, left) + look(scenario, t, {0.0, 0.0, 0.5}, -left);
      ++rays;
      if (width > 2.04 && width < 2.61) ++even;
    }
    CHECK(even >= 0.9 * rays);
  }
}

}  // namespace isobar::test::test_places
