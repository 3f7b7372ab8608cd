// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

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

TEST_CASE("a lidar that stands among clutter is not pulled up or down by its own map") {
  for (const Method method : {Method::k4Dof, Method::k6Dof}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(cluttered_room(), at_rest, without_wheels(drifting(at_rest)), method);
    double highest_m = 0.0;
    for (int i = 0; i < 30; ++i) {
      run.step();
      highest_m = std::max(highest_m, std::abs(run.position_error().z()));
    }
    CHECK(highest_m < 0.006);
  }
}

}  // namespace isobar::test::test_standing
