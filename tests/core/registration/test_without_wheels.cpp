// SPDX-License-Identifier: BSD-3-Clause
// Runs of a robot without wheels: begun in motion, and turns that no gyro feels.
#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "core/geometry.hpp"
#include "core/registration/speed_search.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_without_wheels {

namespace {

/// A street along x between two fronts, with parked cars, trees and entrances that stand across it.
World street() {
  World world;
  world.add_box({-60.0, -9.0, 0.0}, {140.0, 9.0, 30.0}, 1U | 2U | 32U);
  for (int i = 0; i < 22; ++i) {
    const double x_m = -50.0 + 8.5 * i;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double y_m = side * (5.0 + 0.7 * (i % 3));
    world.add_box({x_m, y_m - 0.9, 0.0}, {x_m + 2.0 + 0.5 * (i % 4), y_m + 0.9, 1.5});
    world.add_box({x_m + 4.0, side * 8.0 - 0.15, 0.0}, {x_m + 4.3, side * 8.0 + 0.15, 6.0});
  }
  return world;
}

Motion straight(double speed_m_s) {
  return [speed_m_s](std::int64_t stamp_ns) {
    const double x_m = speed_m_s * 1e-9 * static_cast<double>(stamp_ns - kRunStartNs);
    return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0.5, 0.7));
  };
}

/// Priors that know the time, as those of a lidar alone do.
MakePrior time_alone() {
  return [](std::int64_t stamp_ns) {
    Prior prior;
    prior.stamp_ns = stamp_ns;
    return prior;
  };
}

/// A run of a robot that has a lidar and nothing else.
RegistrationRun lidar_alone(const World& world, const Motion& motion) {
  RegistrationRun run(world, motion, time_alone(), Method::k6Dof);
  RegistrationConfig config;
  config.has_imu = false;
  run.rebuild(config, Method::k6Dof);
  return run;
}

}  // namespace

TEST_CASE("a lidar alone finds the speed of a run that begins in motion, and that of one that stands") {
  for (const double speed_m_s : {0.0, 1.0, 5.0, 8.0}) {
    CAPTURE(speed_m_s);
    RegistrationRun run = lidar_alone(street(), straight(speed_m_s));
    // The map, the search, and the first scans by its speed.
    run.steps(8);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    const Eigen::Vector3d before = run.position_error();
    run.steps(20);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    // Over up to 16 m. A robot that is believed to stand errs by all of it.
    CHECK((run.position_error() - before).norm() < 0.15);
  }
}

TEST_CASE(
    "a speed that fits far better counts at once, one that fits a little better after four scans, standing "
    "at once") {
  const auto outcome = [](double fit_of_moving) {
    SpeedSearch search;
    int scans = 0;
    while (!search.done() && scans < 10) {
      for (std::size_t i = 0; i < SpeedSearch::kHypotheses; ++i) {
        const bool moving = search.velocity_m_s(i).x() > 5.0 && std::abs(search.velocity_m_s(i).y()) < 1.0;
        MatchResult match;
        match.solved = true;
        match.residual_rms_m = 0.015;
        // A wall along the way holds y at any speed.
        match.level_information = Eigen::Vector2d(moving ? fit_of_moving : 1.0, 50.0).asDiagonal();
        search.add(i, match, Eigen::Vector2d(moving ? 0.65 : 0.0, 0.0), 0.1);
      }
      search.end_scan();
      ++scans;
    }
    return std::pair(scans, search.best_m_s());
  };
  CHECK(outcome(4.0).first == 1);
  CHECK(outcome(4.0).second == Eigen::Vector2d(6.5, 0.0));
  CHECK(outcome(1.6).first == SpeedSearch::kScans);
  CHECK(outcome(1.6).second == Eigen::Vector2d(6.5, 0.0));
  CHECK(outcome(1.1).first == 1);
  CHECK(outcome(1.1).second == Eigen::Vector2d::Zero());
}

TEST_CASE("a lidar alone follows a turn that begins within a scan") {
  const Motion turning = [](std::int64_t stamp_ns) {
    const double t = std::max(0.0, 1e-9 * static_cast<double>(stamp_ns - kRunStartNs) - 2.05);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation_about_z(0.6 * t);
    T.translation() = Eigen::Vector3d(0.5, 0.3, 0.7);
    return T;
  };
  RegistrationRun run = lidar_alone(furnished_room(), turning);
  run.steps(20);
  double largest_deg = 0.0;
  for (int i = 0; i < 30; ++i) {
    CHECK(run.step().mode == PoseMode::kRegistered);
    largest_deg = std::max(largest_deg, run.rotation_error_deg());
  }
  // A scan lasts for 3.4 degrees of this turn; the one in which it begins is deskewed as if there were none.
  CHECK(largest_deg < 2.5);
  CHECK(run.rotation_error_deg() < 0.5);
}

}  // namespace isobar::test::test_without_wheels
