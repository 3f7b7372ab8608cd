// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/motion_series.hpp"

#include <doctest/doctest.h>

#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_motion_series {

namespace {
constexpr std::int64_t kMs = 1'000'000;
}

TEST_CASE("a constant rate makes the same motion in every cell, at any pace of the samples") {
  for (const std::int64_t pace : {3 * kMs, 20 * kMs, 130 * kMs}) {
    MotionSeries series;
    for (std::int64_t t = 10'000 * kMs; t <= 13'000 * kMs; t += pace) series.add_rate(t, {0.5, 1.0, -0.2});
    const PlanarSum sum = series.sum(105, 10);
    REQUIRE(sum.turn_known);
    REQUIRE(sum.way_known);
    CHECK(sum.step.turn_rad == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(sum.step.x_m == doctest::Approx(1.0).epsilon(1e-4));
    CHECK(sum.step.y_m == doctest::Approx(-0.2).epsilon(1e-4));
  }
}

TEST_CASE("a gap, a way that is not known and time outside are not known") {
  MotionSeries series;
  series.add_step(1'000 * kMs, 1'200 * kMs, {0.1, 0.2, 0.0}, true);
  series.add_step(1'200 * kMs, 1'300 * kMs, {0.1, 9.0, 0.0}, false);
  series.add_step(1'700 * kMs, 1'900 * kMs, {0.1, 0.2, 0.0}, true);
  series.add_step(1'900 * kMs, 2'300 * kMs, {0.1, 0.2, 0.0}, true);  // longer than the longest gap
  CHECK(series.sum(10, 2).way_known);
  CHECK(series.sum(10, 3).turn_known);
  CHECK_FALSE(series.sum(10, 3).way_known);
  CHECK(series.sum(10, 3).step.x_m == doctest::Approx(0.2));
  CHECK_FALSE(series.sum(12, 2).turn_known);
  CHECK_FALSE(series.sum(9, 2).turn_known);
  CHECK_FALSE(series.turn_known(20));
}

TEST_CASE("stamps that jump forward or back break nothing and allocate nothing") {
  MotionSeries series;
  series.add_rate(1'000 * kMs, {1, 0, 0});
  const std::size_t before = allocation_count();
  for (const std::int64_t t : {std::int64_t{1'100}, std::int64_t{900'000'000}, std::int64_t{900'000'010},
                               std::int64_t{1'200}, std::int64_t{1'300}, std::int64_t{-5}}) {
    series.add_rate(t * kMs, {1, 0, 0});
  }
  CHECK(allocation_count() == before);
  CHECK(series.turn_known(10));
  CHECK_FALSE(series.turn_known(11));
  CHECK(series.turn_known(12));
}

}  // namespace isobar::test::test_motion_series
