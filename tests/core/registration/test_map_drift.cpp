// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/registration/map_drift.hpp"

namespace isobar::test::test_map_drift {

TEST_CASE("a robot that stands gains no error") {
  MapDrift drift;
  drift.move({3.0, 0.0});
  const Eigen::Matrix3d before = drift.covariance();
  for (int i = 0; i < 1000; ++i) drift.move(Eigen::Vector2d::Zero());
  CHECK(drift.covariance() == before);
}

TEST_CASE("the error does not depend on the length of the steps") {
  MapDrift fine;
  MapDrift coarse;
  for (int i = 0; i < 1000; ++i) fine.move({0.1, 0.0});
  for (int i = 0; i < 100; ++i) coarse.move({1.0, 0.0});
  // Euler's rule: the steps of yaw and position alternate, which is first order in the length of a step over the way.
  CHECK((fine.covariance() - coarse.covariance()).norm() < 0.02 * fine.covariance().norm());
}

TEST_CASE("on a straight way yaw makes the error across it, with the variance of an integrated random walk") {
  MapDrift drift;
  for (int i = 0; i < 10'000; ++i) drift.move({0.02, 0.0});
  const Eigen::Matrix3d& P = drift.covariance();
  const double way_m = 200.0;
  // q s^3 / 3 across the way, q s of the yaw, and the walk of the position on both axes.
  CHECK(P(1, 1) - P(0, 0) == doctest::Approx(P(2, 2) * way_m * way_m / 3.0).epsilon(0.01));
  CHECK(std::sqrt(P(2, 2)) == doctest::Approx(5e-4 * std::sqrt(way_m)));
  CHECK(P(1, 2) > 0.0);
}

TEST_CASE("there and back the error across the way is that of the turn between") {
  MapDrift there;
  MapDrift back;
  for (int i = 0; i < 1000; ++i) {
    there.move({0.1, 0.0});
    back.move({0.1, 0.0});
  }
  for (int i = 0; i < 1000; ++i) there.move({0.1, 0.0});
  for (int i = 0; i < 1000; ++i) back.move({-0.1, 0.0});
  CHECK(back.covariance()(1, 1) < 0.5 * there.covariance()(1, 1));
}

}  // namespace isobar::test::test_map_drift
