// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ray_caster.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "simulation/random.hpp"

namespace isobar::test::test_ray_caster {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

Vector3d draw_point(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  const double z = random.uniform(-size, size);
  return {x, y, z};
}

/// Exhaustive search in double precision, independent of the ray caster: plane, then the three edges.
double nearest(const Mesh& mesh, const Vector3d& origin, const Vector3d& direction, double limit) {
  double best = limit;
  for (const Triangle& triangle : mesh.triangles()) {
    const Vector3d a = triangle.a.cast<double>();
    const Vector3d b = triangle.b.cast<double>();
    const Vector3d c = triangle.c.cast<double>();
    const Vector3d normal = (b - a).cross(c - a);
    const double t = normal.dot(a - origin) / normal.dot(direction);
    if (!(t > 0.0 && t < best)) continue;
    const Vector3d p = origin + t * direction;
    const bool inside = (b - a).cross(p - a).dot(normal) >= 0.0 && (c - b).cross(p - b).dot(normal) >= 0.0 &&
                        (a - c).cross(p - c).dot(normal) >= 0.0;
    if (inside) best = t;
  }
  return best;
}

Mesh draw_mesh(Random& random) {
  Mesh mesh;
  for (int i = 0; i < 400; ++i) {
    const Vector3d at = draw_point(random, 10.0);
    mesh.triangle(at, at + draw_point(random, 1.5), at + draw_point(random, 1.5), Surface::kWood);
  }
  for (int i = 0; i < 40; ++i) {
    const Vector3d at = draw_point(random, 10.0);
    mesh.box(at, at + draw_point(random, 1.0).cwiseAbs(), Surface::kMetal);
  }
  return mesh;
}

}  // namespace

TEST_CASE("the nearest hit is that of an exhaustive search") {
  Random random(42);
  const Mesh mesh = draw_mesh(random);
  const RayCaster caster(mesh);
  int hits = 0;
  int differences = 0;
  constexpr int kRays = 5000;
  for (int i = 0; i < kRays; ++i) {
    const Vector3d origin = draw_point(random, 12.0);
    const Vector3d direction = draw_point(random, 1.0).normalized();
    const double expected = nearest(mesh, origin, direction, 50.0);
    const Hit hit = caster.cast(origin.cast<float>(), direction.cast<float>(), 50.0F);
    hits += hit.found ? 1 : 0;
    // Single precision at 20 m: some micrometres, more for a triangle seen almost edge-on. A ray that grazes
    // an edge may pass on either side of it.
    if (std::abs(static_cast<double>(hit.distance_m) - expected) > 1e-3) ++differences;
  }
  CHECK(hits > kRays / 10);
  CHECK(hits < kRays);
  CHECK(differences <= 2);
}

TEST_CASE("rays along the axes and from inside a box hit its walls") {
  Mesh mesh;
  mesh.box({-1.0, -2.0, -3.0}, {4.0, 5.0, 6.0}, Surface::kConcrete);
  const RayCaster caster(mesh);
  const Eigen::Vector3f eye(0.25F, 0.25F, 0.25F);
  const float expected[6] = {3.75F, 4.75F, 5.75F, 1.25F, 2.25F, 3.25F};
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {1, -1}) {
      const Eigen::Vector3f direction = static_cast<float>(sign) * Eigen::Vector3f::Unit(axis);
      const Hit hit = caster.cast(eye, direction, 100.0F);
      CHECK(hit.found);
      CHECK(hit.distance_m == doctest::Approx(expected[axis + (sign < 0 ? 3 : 0)]));
      CHECK(hit.cos_incidence == doctest::Approx(1.0));
      CHECK(hit.surface == Surface::kConcrete);
    }
  }
}

TEST_CASE("there is no hit beyond the limit and none in an empty world") {
  Mesh mesh;
  mesh.quad({5.0, -1.0, -1.0}, {5.0, 1.0, -1.0}, {5.0, 1.0, 1.0}, {5.0, -1.0, 1.0}, Surface::kWood);
  const RayCaster wall(mesh);
  CHECK(wall.cast(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), 5.1F).found);
  CHECK_FALSE(wall.cast(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), 4.9F).found);
  CHECK_FALSE(RayCaster(Mesh{}).cast(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), 100.0F).found);
}

}  // namespace isobar::test::test_ray_caster
