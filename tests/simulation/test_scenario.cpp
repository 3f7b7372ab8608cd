// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenario.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

namespace isobar::test::test_scenario {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

/// Distance to the nearest obstacle from a point of base_link in a direction of base_link [m].
double look(const Scenario& scenario, double time_s, const Vector3d& from_base,
            const Vector3d& direction_base) {
  const MotionState state = scenario.trajectory.at(time_s);
  const Vector3d eye = state.p_world + state.q_world_base * from_base;
  World::Moment moment;
  scenario.world.look(time_s, eye, 50.0, moment);
  return scenario.world.cast(moment, eye, state.q_world_base * direction_base, 50.0).distance_m;
}

/// Minimum horizontal distance from the robot's centre to any obstacle, 0.45 m above the floor, over the run.
double least_clearance(const Scenario& scenario) {
  double least = 50.0;
  for (double t = 0.0; t < scenario.trajectory.duration_s(); t += 0.2) {
    for (int i = 0; i < 24; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 24;
      const double free = look(scenario, t, {0.0, 0.0, 0.45}, {std::cos(angle), std::sin(angle), 0.0});
      least = std::min(least, free);
    }
  }
  return least;
}

struct Height {
  double lowest = 10.0;
  double highest = -10.0;
};

/// Height of the robot's centre above the surface below it.
Height height_above_floor(const Scenario& scenario) {
  Height height;
  for (double t = 0.0; t < scenario.trajectory.duration_s(); t += 0.1) {
    const double above = look(scenario, t, {0.0, 0.0, 0.5}, -Vector3d::UnitZ()) - 0.5;
    height.lowest = std::min(height.lowest, above);
    height.highest = std::max(height.highest, above);
  }
  return height;
}

double travelled_m(const Scenario& scenario, const std::string& label) {
  double sum = 0.0;
  for (const LabelledSpan& span : scenario.labels) {
    if (span.label != label) continue;
    for (double t = span.start_s; t < span.end_s; t += 0.05) {
      const Vector3d step =
          scenario.trajectory.at(std::min(t + 0.05, span.end_s)).p_world - scenario.trajectory.at(t).p_world;
      sum += step.norm();
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("in every building, the robot stays clear of walls and people and on the floor") {
  struct Case {
    Scenario (*make)(std::uint64_t, bool);
    bool short_form;
  };
  for (const Case& test :
       {Case{make_three_floors, true}, Case{make_three_floors, false}, Case{make_stairs_demo, false},
        Case{make_stairs_demo, true}, Case{make_elevator, true}, Case{make_elevator, false},
        Case{make_stairs, true}, Case{make_stairs, false}, Case{make_corridor, true},
        Case{make_corridor, false}, Case{make_parking, true}, Case{make_parking, false},
        Case{make_four_floors, true}}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Scenario scenario = test.make(seed, test.short_form);
      CAPTURE(scenario.description);
      CAPTURE(seed);
      CHECK(least_clearance(scenario) > 0.35);  // half of the robot's width
      const Height height = height_above_floor(scenario);
      // On the flat the tracks touch the floor. On stairs they roll on the edges of the steps: up to a rise
      // of 0.18 m above the tread behind an edge, and a few centimetres below the edge where the slope
      // changes.
      CHECK(height.lowest > -0.05);
      CHECK(height.highest < 0.25);
    }
  }
}

TEST_CASE("four-floors has four storeys whose walls and furniture are equal, and visits all of them") {
  const Scenario scenario = make_four_floors(3, true);
  double highest_m = 0.0;
  double farthest_m = 0.0;
  for (const RawPose& pose : scenario.raw) {
    highest_m = std::max(highest_m, pose.z_m);
    farthest_m = std::max(farthest_m, pose.x_m);
  }
  const double storey_m = highest_m / 3.0;
  const double shaft_m = farthest_m - 1.6;  // the robot stands in the middle of the cabin
  std::array<int, 4> visited{};
  int rays = 0;
  int different = 0;
  for (std::size_t i = 0; i < scenario.raw.size(); i += 50) {
    const RawPose& pose = scenario.raw[i];
    const double storeys = pose.z_m / storey_m;
    if (std::abs(storeys - std::round(storeys)) < 0.01) {
      ++visited.at(static_cast<std::size_t>(std::lround(storeys)));
    }
    if (pose.x_m < 1.0 || pose.x_m > shaft_m || pose.z_m > 0.01) continue;
    for (int k = 0; k < 36; ++k) {
      const double angle = k * std::numbers::pi / 18.0;
      const Eigen::Vector3f direction =
          Vector3d(std::cos(angle), std::sin(angle), -0.1 + 0.01 * k).normalized().cast<float>();
      const Vector3d eye(pose.x_m, pose.y_m, 0.6);
      const Hit here = scenario.world.standing().cast(eye.cast<float>(), direction, 8.0F);
      const double hit_m = eye.x() + static_cast<double>(here.distance_m * direction.x());
      // Stairs and shaft lead on at some storeys and end at others.
      if (!here.found || hit_m < 0.1 || hit_m > shaft_m) continue;
      for (int storey = 1; storey < 4; ++storey) {
        const Vector3d above = eye + Vector3d(0.0, 0.0, storey * storey_m);
        const Hit there = scenario.world.standing().cast(above.cast<float>(), direction, 8.0F);
        ++rays;
        if (std::abs(there.distance_m - here.distance_m) > 0.05F)
          ++different;  // the height of a storey is known to some mm
      }
    }
  }
  CHECK(rays > 1'000);
  CHECK(different < rays / 200);  // rays that graze an edge
  for (const int count : visited) CHECK(count > 0);
}

TEST_CASE("three-floors is the paper's run: 311 m of corridors, 12 m of height, a long featureless stretch") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scenario scenario = make_three_floors(seed, false);
    const double start_m = scenario.trajectory.at(0.0).p_world.z();
    const double end_m = scenario.trajectory.at(scenario.trajectory.duration_s()).p_world.z();
    CHECK(end_m - start_m > 11.0);
    CHECK(end_m - start_m < 13.0);
    const double flat_m = travelled_m(scenario, "flat");
    CHECK(flat_m > 290.0);
    CHECK(flat_m < 330.0);
    CHECK(std::count_if(scenario.labels.begin(), scenario.labels.end(),
                        [](const LabelledSpan& span) { return span.label == "stairs"; }) == 2);
  }
}

TEST_CASE("short forms last 30 to 90 s; full runs start with 3 to 8 s at rest") {
  for (const auto make : {make_three_floors, make_elevator, make_moulin, make_stairs_demo, make_hill,
                          make_parking, make_stairs, make_corridor, make_city}) {
    const Scenario brief = make(4, true);
    CAPTURE(brief.description);
    CHECK(brief.trajectory.duration_s() > 30.0);
    CHECK(brief.trajectory.duration_s() < 90.0);
    const Scenario whole = make(4, false);
    CHECK(whole.trajectory.duration_s() > brief.trajectory.duration_s());
    for (double t = 0.0; t < 2.8; t += 0.1) CHECK(whole.trajectory.at(t).v_world.norm() < 1e-6);
    CHECK(whole.trajectory.at(10.0).v_world.norm() > 0.05);
  }
}

TEST_CASE("during an elevator ride, the distances to the walls and floor of the cabin are constant") {
  const Scenario scenario = make_elevator(2, true);
  const auto ride = std::find_if(scenario.labels.begin(), scenario.labels.end(),
                                 [](const LabelledSpan& span) { return span.label == "elevator"; });
  REQUIRE(ride != scenario.labels.end());
  const double middle_s = 0.5 * (ride->start_s + ride->end_s);
  CHECK(std::abs(scenario.trajectory.at(middle_s).v_world.z()) > 0.5);
  // The label lasts until the doors are open again; the ride is the part with motion.
  double end_s = ride->end_s;
  while (std::abs(scenario.trajectory.at(end_s).v_world.z()) < 0.01) end_s -= 0.05;
  for (const Vector3d& direction :
       {Vector3d(-Vector3d::UnitZ()), Vector3d(Vector3d::UnitZ()), Vector3d(Vector3d::UnitX()),
        Vector3d(-Vector3d::UnitX()), Vector3d(Vector3d::UnitY()), Vector3d(-Vector3d::UnitY())}) {
    const double before = look(scenario, ride->start_s, {0.0, 0.0, 0.6}, direction);
    CHECK(before < 2.0);
    for (double t = ride->start_s; t < end_s; t += 0.3) {
      // Tolerance: single precision at 40 m, some micrometres.
      CHECK(std::abs(look(scenario, t, {0.0, 0.0, 0.6}, direction) - before) < 1e-4);
    }
  }
}

TEST_CASE("the sphere hangs in the shaft, and the specific force on its accelerometer is along the rope") {
  const Scenario scenario = make_moulin(3, false);
  double worst_rad = 0.0;
  double tilt_rad = 0.0;
  for (double t = 12.0; t < scenario.trajectory.duration_s(); t += 0.1) {
    const MotionState state = scenario.trajectory.at(t);
    const Vector3d force = state.q_world_base.conjugate() * (state.a_world + Vector3d(0.0, 0.0, 9.80665));
    worst_rad = std::max(worst_rad, std::atan2(force.head<2>().norm(), force.z()));
    const Vector3d up = state.q_world_base * Vector3d::UnitZ();
    tilt_rad = std::max(tilt_rad, std::acos(std::min(1.0, up.z())));
  }
  CHECK(tilt_rad > 0.005);
  CHECK(tilt_rad < 0.15);
  // Not an ideal pendulum, because the length of the rope changes unevenly.
  CHECK(worst_rad < 0.5 * tilt_rad + 0.01);
  CHECK(least_clearance(scenario) > 0.6);
}

}  // namespace isobar::test::test_scenario
