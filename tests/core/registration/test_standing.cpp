// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_standing {

namespace {

Eigen::Isometry3d at_rest(std::int64_t /*stamp_ns*/) {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.7));
}

// A room whose floor is full of things of 5 to 30 cm: most cells of the map hold more than one surface.
World cluttered_room() {
  World world;
  world.add_box({-4.0, -3.0, 0.0}, {4.0, 3.0, 2.6});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d lowest(-3.8 + 7.4 * unit(random), -2.8 + 5.4 * unit(random), 0.0);
    const Eigen::Vector3d size(0.05 + 0.2 * unit(random), 0.05 + 0.2 * unit(random),
                               0.05 + 0.25 * unit(random));
    if (lowest.head<2>().norm() > 0.8) world.add_box(lowest, lowest + size);
  }
  return world;
}

}  // namespace

namespace {

// Priors of an IMU that feels no motion; no wheels.
MakePrior feels_nothing(const Motion& motion) {
  return [make = without_wheels(drifting(motion))](std::int64_t stamp_ns) {
    Prior prior = make(stamp_ns);
    prior.may_stand = true;
    prior.standing_still = false;
    return prior;
  };
}

// Along x at 1 cm/s, from the end of the first second.
Eigen::Isometry3d creeping(std::int64_t stamp_ns) {
  const double s = std::max(0.0, seconds_between(kRunStartNs, stamp_ns) - 1.0);
  return Eigen::Isometry3d(Eigen::Translation3d(0.01 * s, 0.0, 0.7));
}

}  // namespace

TEST_CASE("a lidar that stands among clutter is hardly pulled up or down by its own map") {
  for (const Method method : {Method::k4Dof, Method::k6Dof}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(cluttered_room(), at_rest, without_wheels(drifting(at_rest)), method);
    double highest_m = 0.0;
    for (int i = 0; i < 30; ++i) {
      run.step();
      highest_m = std::max(highest_m, std::abs(run.position_error().z()));
    }
    // Cells with a box and the floor take one plane between them: 5 to 8 mm, of half a metre of clutter.
    CHECK(highest_m < 0.01);
  }
}

TEST_CASE("a lidar whose IMU feels no motion stays where it is") {
  for (const Method method : {Method::k4Dof, Method::k6Dof}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(cluttered_room(), at_rest, feels_nothing(at_rest), method);
    double farthest_m = 0.0;
    for (int i = 0; i < 25; ++i) {
      run.step();
      farthest_m = std::max(farthest_m, run.position_error().norm());
    }
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(farthest_m < 0.001);
  }
}

TEST_CASE("a motion that the IMU does not feel is followed by the scans") {
  RegistrationRun slow(cluttered_room(), creeping, feels_nothing(creeping), Method::k6Dof);
  double farthest_m = 0.0;
  for (int i = 0; i < 60; ++i) {
    slow.step();
    farthest_m = std::max(farthest_m, slow.position_error().norm());
  }
  // 5 cm of way; held up to 15 mm at a time, and the scans' own error.
  CHECK(farthest_m < 0.03);
  RegistrationRun fast(cluttered_room(), along_x, feels_nothing(along_x), Method::k6Dof);
  RegistrationRun unheld(cluttered_room(), along_x, without_wheels(drifting(along_x)), Method::k6Dof);
  fast.steps(16);
  unheld.steps(16);
  CHECK(fast.position_error().norm() < unheld.position_error().norm() + 0.03);
}

}  // namespace isobar::test::test_standing
