// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/city_furniture.hpp"

#include <cmath>
#include <numbers>

namespace isobar::simulation {

using Eigen::Vector3d;

namespace {

/// Distance kept free at corners, where people cross and cars turn.
constexpr double kCornerM = 4.5;

/// Level frame at (u, d) of another frame, `above_m` above the terrain.
CityFrame standing(const CityFrame& frame, double u, double d, const Terrain& terrain, double above_m) {
  CityFrame at = frame;
  at.origin_m.head<2>() = frame.plan(u, d);
  at.origin_m.z() = terrain.height_m(at.origin_m.head<2>()) + above_m;
  return at;
}

void add_lamp(Mesh& mesh, const CityFrame& foot, Random& random) {
  const double height = random.uniform(4.5, 7.0);
  mesh.prism(foot.origin_m, random.uniform(0.06, 0.11), height, 6, Surface::kMetal);
  foot.box(mesh, -0.1, 0.1, 0.0, 1.2, height - 0.15, height, Surface::kMetal);
}

/// A random small object of a pavement.
void add_small(Mesh& mesh, const CityFrame& foot, Random& random) {
  switch (random.integer(0, 4)) {
    case 0:  // post with a sign
      mesh.prism(foot.origin_m, 0.04, 2.6, 5, Surface::kMetal);
      foot.box(mesh, -0.3, 0.3, -0.02, 0.02, 2.0, 2.6, Surface::kMetal);
      break;
    case 1:  // bin
      mesh.prism(foot.origin_m, 0.25, random.uniform(0.8, 1.1), 8, Surface::kMetal);
      break;
    case 2:  // bench
      foot.box(mesh, -0.9, 0.9, -0.45, 0.0, 0.40, 0.46, Surface::kWood);
      foot.box(mesh, -0.9, 0.9, -0.50, -0.45, 0.46, 0.90, Surface::kWood);
      foot.box(mesh, -0.8, -0.7, -0.4, -0.05, 0.0, 0.40, Surface::kConcrete);
      foot.box(mesh, 0.7, 0.8, -0.4, -0.05, 0.0, 0.40, Surface::kConcrete);
      break;
    case 3:  // cabinet of a telephone or power company
      foot.box(mesh, -0.5, 0.5, -0.4, 0.0, 0.0, random.uniform(1.0, 1.5), Surface::kMetal);
      break;
    default:  // a row of bollards
      for (int i = 0; i < 4; ++i) mesh.prism(foot.at(1.5 * i, 0.0, 0.0), 0.08, 0.9, 6, Surface::kMetal);
  }
}

}  // namespace

void add_car(Mesh& mesh, const CityFrame& frame, Random& random) {
  const double half = 0.5 * kCarLengthM - random.uniform(0.0, 0.25);
  const double wide = random.uniform(0.80, 0.90);
  const double waist = random.uniform(0.80, 1.0);
  const bool van = random.chance(0.15);
  const double roof = van ? random.uniform(1.9, 2.3) : random.uniform(1.4, 1.65);
  frame.box(mesh, -half, half, -wide, wide, 0.28, waist, Surface::kMetal);
  for (const double u : {-0.65 * half, 0.65 * half}) {
    frame.box(mesh, u - 0.3, u + 0.3, -wide + 0.02, wide - 0.02, 0.0, 0.6, Surface::kCloth);
  }
  // The cabin: inclined front and rear screens and side windows.
  const double front0 = van ? 0.9 * half : 0.45 * half;
  const double front1 = front0 - (van ? 0.3 : 0.7);
  const double rear0 = van ? -half : -0.85 * half;
  const double rear1 = van ? -half : rear0 + 0.4;
  const double in = wide - (van ? 0.03 : 0.18);
  const auto low = [&](double u, double side) { return frame.at(u, side * wide, waist); };
  const auto high = [&](double u, double side) { return frame.at(u, side * in, roof); };
  for (const double side : {-1.0, 1.0}) {
    mesh.quad(low(rear0, side), low(front0, side), high(front1, side), high(rear1, side), Surface::kIce);
  }
  mesh.quad(low(front0, -1.0), low(front0, 1.0), high(front1, 1.0), high(front1, -1.0), Surface::kIce);
  mesh.quad(low(rear0, -1.0), low(rear0, 1.0), high(rear1, 1.0), high(rear1, -1.0), Surface::kIce);
  mesh.quad(high(rear1, -1.0), high(front1, -1.0), high(front1, 1.0), high(rear1, 1.0), Surface::kMetal);
}

void add_tree(Mesh& mesh, const Vector3d& foot, Random& random) {
  const double trunk = random.uniform(2.2, 3.2);
  const double crown = random.uniform(1.2, 2.3);
  mesh.prism(foot - Vector3d(0.0, 0.0, 0.3), random.uniform(0.10, 0.25), trunk + 1.3, 7, Surface::kWood);
  const Vector3d middle = foot + Vector3d(0.0, 0.0, trunk + 0.8 * crown);
  constexpr int kLeaves = 60;
  for (int i = 0; i < kLeaves; ++i) {
    const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double z = random.uniform(-1.0, 1.0);
    const double reach = crown * std::cbrt(random.uniform(0.1, 1.0));
    const double flat = reach * std::sqrt(1.0 - z * z);
    const Vector3d leaf = middle + Vector3d(flat * std::cos(azimuth), flat * std::sin(azimuth), reach * z);
    std::array<Vector3d, 3> corners;
    for (Vector3d& corner : corners) {
      for (int axis = 0; axis < 3; ++axis) corner[axis] = leaf[axis] + random.uniform(-0.45, 0.45);
    }
    mesh.triangle(corners[0], corners[1], corners[2], Surface::kWood);
  }
}

void add_kerbside(Mesh& mesh, const CityFrame& kerb, double length_m, const Street& street,
                  const Terrain& terrain, Random& random) {
  const double end_m = length_m - kCornerM;
  for (double u = random.uniform(kCornerM, 15.0); u < end_m; u += random.uniform(22.0, 32.0)) {
    add_lamp(mesh, standing(kerb, u, -0.6, terrain, kKerbM), random);
  }
  for (double u = kCornerM + random.uniform(0.0, 5.0); u < end_m; u += random.uniform(4.0, 22.0)) {
    if (u < end_m - 5.0) add_small(mesh, standing(kerb, u, -0.55, terrain, kKerbM), random);
  }
  if (street.tree_every_m > 0.0) {
    for (double u = kCornerM + random.uniform(1.0, 6.0); u < end_m;
         u += street.tree_every_m * random.uniform(0.8, 1.2)) {
      if (random.chance(0.85)) add_tree(mesh, standing(kerb, u, -0.9, terrain, kKerbM).origin_m, random);
    }
  }
  if (!street.parking) return;
  constexpr double kFirstCarM = 9.0;
  for (double u = kFirstCarM; u < length_m - kFirstCarM; u += random.uniform(5.2, 6.8)) {
    if (random.chance(0.35)) continue;
    CityFrame car = standing(kerb, u, random.uniform(1.0, 1.15), terrain, 0.0);
    car.rise = terrain.slope(car.origin_m.head<2>()).dot(car.along);
    if (random.chance(0.1)) {  // parked in the opposite direction
      car.along = -car.along;
      car.rise = -car.rise;
    }
    add_car(mesh, car, random);
  }
}

}  // namespace isobar::simulation
