// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.hpp"

#include <doctest/doctest.h>

namespace isobar::test::test_world {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

/// A box of 1 m that moves along x from the given position during a part of the run.
MovingBody make_box(double x_m, double speed_m_s, std::size_t first, std::size_t samples) {
  Mesh shape;
  shape.box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, Surface::kMetal);
  std::vector<double> x;
  for (std::size_t i = 0; i < samples; ++i) {
    x.push_back(x_m + speed_m_s * SplineGrid::kStepS * static_cast<double>(i));
  }
  const Channel zero(std::vector<double>(samples, 0.0));
  return {RayCaster(shape), Channel(std::move(x)), zero, zero, first};
}

double look(const World& world, double time_s) {
  World::Moment moment;
  world.look(time_s, Vector3d::Zero(), 50.0, moment);
  return world.cast(moment, Vector3d::Zero(), Vector3d::UnitX(), 50.0).distance_m;
}

}  // namespace

TEST_CASE("a moving body is hit at its position at the time of the ray, and only while it exists") {
  // 100 samples are 5 s; the second body exists from 2 s to 4 s.
  const World world(Mesh{}, {make_box(20.0, 0.0, 0, 100), make_box(5.0, 2.0, 40, 40)});
  CHECK(look(world, 1.0) == doctest::Approx(19.5));
  CHECK(look(world, 2.5) == doctest::Approx(5.5));  // 5 m + 0.5 s * 2 m/s, minus half of the box
  CHECK(look(world, 3.5) == doctest::Approx(7.5));
  CHECK(look(world, 4.5) == doctest::Approx(19.5));
}

}  // namespace isobar::test::test_world
