// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/registration/search_schedule.hpp"

namespace isobar::test::test_search_schedule {

namespace {

Vector6d step_of(double metres) {
  Vector6d step = Vector6d::Zero();
  step(3) = metres;
  return step;
}

}  // namespace

TEST_CASE(
    "two coarse iterations come before the fine ones, and the search distance halves to its last value") {
  const RegistrationConfig config;
  SearchSchedule schedule(config, 0.4);
  CHECK(schedule.distance_m() == doctest::Approx(config.first_distance_m + 0.4));
  double distance_m = schedule.distance_m();
  for (int i = 0; i < 5; ++i) {
    CHECK(schedule.stride() == (i < 2 ? 3 : 1));
    CHECK(schedule.share() * static_cast<double>(schedule.stride()) == doctest::Approx(1.0));
    CHECK(schedule.distance_m() == doctest::Approx(distance_m));
    schedule.advance(step_of(0.1));
    distance_m = std::max(config.last_distance_m, 0.5 * distance_m);
  }
  CHECK(schedule.distance_m() == config.last_distance_m);
  // The steps are large: the pose is still off, and nothing ends here.
  CHECK(schedule.choice() == PairChoice::kNearest);
  CHECK_FALSE(schedule.converged(step_of(0.0)));
}

TEST_CASE("a small coarse step goes to the fine iterations at the last distance at once") {
  const RegistrationConfig config;
  SearchSchedule schedule(config, 100.0);
  CHECK(schedule.distance_m() == doctest::Approx(config.first_distance_m + 2.0));
  CHECK_FALSE(schedule.converged(step_of(0.0)));  // coarse iterations never end a registration
  CHECK(schedule.choice() == PairChoice::kNearest);
  schedule.advance(step_of(0.001));
  CHECK(schedule.choice() == PairChoice::kOwnCell);
  CHECK(schedule.stride() == 1);
  CHECK(schedule.distance_m() == config.last_distance_m);
  CHECK(schedule.converged(step_of(0.5 * config.convergence_m)));
  CHECK_FALSE(schedule.converged(step_of(2.0 * config.convergence_m)));
}

}  // namespace isobar::test::test_search_schedule
