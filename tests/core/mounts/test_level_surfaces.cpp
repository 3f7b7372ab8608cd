// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "core/geometry.hpp"
#include "core/mounts/level_surfaces.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_level_surfaces {

namespace {

// n . p = d, seen from the side of the lidar.
struct Wall {
  Eigen::Vector3d normal;
  double distance_m;
};
using World = std::vector<Wall>;

// Box around the lidar: floor 0.6 m below, ceiling 2.2 m above, walls in front, behind and at both sides.
World room(double half_length_m, double half_width_m) {
  return {{-Eigen::Vector3d::UnitZ(), 0.6},          {Eigen::Vector3d::UnitZ(), 2.2},
          {Eigen::Vector3d::UnitX(), half_length_m}, {-Eigen::Vector3d::UnitX(), half_length_m},
          {Eigen::Vector3d::UnitY(), half_width_m},  {-Eigen::Vector3d::UnitY(), half_width_m}};
}

// Points of five scans of 16 beams, by a mount that is off by `mount_deg` and a robot tilted by `q_world_base`.
class Lidar {
 public:
  explicit Lidar(std::uint64_t seed = 1) : random_(seed) {}

  void scan(const World& world, const Eigen::Quaterniond& q_world_base, const Eigen::Vector3d& mount_deg,
            LevelSurfaces& surfaces) {
    const Eigen::Quaterniond q_mount = exp_so3(mount_deg * kRadPerDeg);
    for (int revolution = 0; revolution < 5; ++revolution) {
      points_.clear();
      for (int ring = -15; ring <= 15; ring += 2) {
        for (int azimuth = 0; azimuth < 360; ++azimuth) add(world, q_world_base * q_mount, ring, azimuth);
      }
      surfaces.add(points_);
    }
  }

  /// Points all over the field of view, without rings: the scan of a Mid-360, 7 deg below the horizon to 52 above.
  void scan_without_rings(const World& world, const Eigen::Quaterniond& q_world_lidar,
                          LevelSurfaces& surfaces) {
    points_.clear();
    std::uniform_real_distribution<double> elevation_deg(-7.0, 52.0);
    std::uniform_real_distribution<double> azimuth_deg(0.0, 360.0);
    for (int i = 0; i < 25'000; ++i) {
      const double elevation = elevation_deg(random_);
      add(world, q_world_lidar, elevation, azimuth_deg(random_));
    }
    for (ScanPoint& point : points_) point.ring = 0;
    surfaces.add(points_);
  }
  /// A single laser at the height of the horizon.
  void scan_of_one_laser(const World& world, const Eigen::Quaterniond& q_world_lidar,
                         LevelSurfaces& surfaces) {
    points_.clear();
    for (int i = 0; i < 20'000; ++i) add(world, q_world_lidar, 0.0, 0.018 * i);
    for (ScanPoint& point : points_) point.ring = 0;
    surfaces.add(points_);
  }

 private:
  void add(const World& world, const Eigen::Quaterniond& q_world_lidar, double ring_deg, double azimuth_deg) {
    const double up = ring_deg * kRadPerDeg;
    const double around = azimuth_deg * kRadPerDeg;
    const Eigen::Vector3d ray(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
    const Eigen::Vector3d ray_world = q_world_lidar * ray;
    double range_m = 50.0;
    for (const Wall& wall : world) {
      const double along = wall.normal.dot(ray_world);
      if (along > 1e-6) range_m = std::min(range_m, wall.distance_m / along);
    }
    if (range_m >= 50.0) return;
    const Eigen::Vector3f p = ((range_m + 0.015 * normal_(random_)) * ray).cast<float>();
    points_.push_back({p.x(), p.y(), p.z(), 0, static_cast<std::uint8_t>((ring_deg + 15.0) / 2.0), 0});
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<ScanPoint> points_;
};

// The mount's error [deg] that the surfaces show, with gravity exact; roll and pitch only.
std::optional<Eigen::Vector2d> found_deg(const World& world, const Eigen::Vector3d& mount_deg,
                                         const Eigen::Vector3d& robot_rpy_deg = Eigen::Vector3d::Zero(),
                                         Eigen::Vector2d* sigma_deg = nullptr) {
  LevelSurfaces surfaces;
  const Eigen::Quaterniond q_world_base(rotation_from_rpy_deg(robot_rpy_deg));
  Lidar().scan(world, q_world_base, mount_deg, surfaces);
  const Eigen::Vector3d up = q_world_base.conjugate() * Eigen::Vector3d::UnitZ();
  const auto level = surfaces.find(up, squared(0.1 * kRadPerDeg));
  if (!level) return std::nullopt;
  if (sigma_deg != nullptr) *sigma_deg = level->covariance_rad2.diagonal().head<2>().cwiseSqrt() / kRadPerDeg;
  // up(surfaces) = exp(-e) up(gravity): for small e, e = up(surfaces) x up(gravity) across up.
  return (level->up_by_surfaces.cross(level->up_by_gravity) / kRadPerDeg).head<2>();
}

}  // namespace

TEST_CASE("a room tells roll and pitch of the mount to 0.1 deg, also to a robot that stands askew") {
  for (const Eigen::Vector3d& mount_deg :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.5, -0.8, 0.6), Eigen::Vector3d(-1.5, 1.0, 0.0)}) {
    for (const Eigen::Vector3d& robot_deg :
         {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(2.0, -3.0, 30.0)}) {
      const auto found = found_deg(room(6.0, 4.0), mount_deg, robot_deg);
      REQUIRE(found);
      CHECK((*found - mount_deg.head<2>()).cwiseAbs().maxCoeff() < 0.1);
    }
  }
}

TEST_CASE("the sigma of a room holds the accelerometer's bias: 0.3 to 0.4 deg") {
  Eigen::Vector2d sigma_deg;
  REQUIRE(found_deg(room(6.0, 4.0), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), &sigma_deg));
  CHECK(sigma_deg.minCoeff() > 0.29);
  CHECK(sigma_deg.maxCoeff() < 0.4);
}

TEST_CASE("a corridor of 2.5 m tells roll and pitch by its floor and walls") {
  const Eigen::Vector3d mount_deg(0.5, -0.8, 0.0);
  const auto found = found_deg(room(20.0, 1.25), mount_deg);
  REQUIRE(found);
  CHECK((*found - mount_deg.head<2>()).cwiseAbs().maxCoeff() < 0.15);
}

TEST_CASE("a lidar without rings tells the tilt by a ceiling, or by a floor alone") {
  World hall = room(12.0, 9.0);
  for (const bool roofed : {true, false}) {
    if (!roofed) hall.erase(hall.begin() + 1);
    LevelSurfaces surfaces;
    const Eigen::Vector3d mount_deg(0.5, -0.8, 0.0);
    Lidar().scan_without_rings(hall, exp_so3(mount_deg * kRadPerDeg), surfaces);
    const auto level = surfaces.find(Eigen::Vector3d::UnitZ(), squared(0.1 * kRadPerDeg));
    REQUIRE(level);
    const Eigen::Vector3d found_deg = level->up_by_surfaces.cross(level->up_by_gravity) / kRadPerDeg;
    CHECK((found_deg - mount_deg).head<2>().norm() < 0.15);
  }
}

TEST_CASE("the line of one laser on walls is no floor, by a mount that is off by 1 deg as well") {
  for (const Eigen::Vector3d& mount_deg : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.6, 0.8, 0.0)}) {
    LevelSurfaces surfaces;
    World walls = room(6.0, 4.0);
    walls.erase(walls.begin(), walls.begin() + 2);
    const Eigen::Quaterniond q = exp_so3(mount_deg * kRadPerDeg);
    // Walls all over, so that they are found, and the line besides.
    Lidar lidar;
    lidar.scan_of_one_laser(walls, q, surfaces);
    lidar.scan_without_rings(walls, q, surfaces);
    CHECK_FALSE(surfaces.find(Eigen::Vector3d::UnitZ(), squared(0.1 * kRadPerDeg)));
  }
}

TEST_CASE("a ramp between plumb walls tells nothing") {
  World ramp = room(6.0, 4.0);
  const Eigen::Quaterniond slope(rotation_from_rpy_deg({0.0, 2.0, 0.0}));
  ramp[0].normal = slope * ramp[0].normal;
  ramp[1].normal = slope * ramp[1].normal;
  // The robot stands on the ramp, so that its floor is level in its own axes.
  CHECK_FALSE(found_deg(ramp, Eigen::Vector3d::Zero(), {0.0, 2.0, 0.0}));
}

TEST_CASE("ground without walls tells nothing, level or not") {
  CHECK_FALSE(found_deg({{-Eigen::Vector3d::UnitZ(), 0.6}}, Eigen::Vector3d::Zero()));
  const Eigen::Quaterniond slope(rotation_from_rpy_deg({4.0, 0.0, 0.0}));
  CHECK_FALSE(found_deg({{slope * -Eigen::Vector3d::UnitZ(), 0.6}}, Eigen::Vector3d::Zero()));
}

TEST_CASE("walls that lean every way tell nothing") {
  World rocks = room(6.0, 4.0);
  const double leans_deg[] = {3.0, -4.0, 2.5, -3.5};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d axis = rocks[2 + i].normal.cross(Eigen::Vector3d::UnitZ());
    rocks[2 + i].normal = exp_so3(leans_deg[i] * kRadPerDeg * axis) * rocks[2 + i].normal;
  }
  CHECK_FALSE(found_deg(rocks, Eigen::Vector3d::Zero()));
}

TEST_CASE("after construction nothing is allocated, and points beyond the capacity are ignored") {
  LevelSurfaces surfaces;
  std::vector<ScanPoint> points(10'000, ScanPoint{1.0F, 2.0F, 3.0F, 0, 0, 0});
  const std::size_t before = allocation_count();
  for (int i = 0; i < 10; ++i) surfaces.add(points);
  CHECK(surfaces.full());
  CHECK_FALSE(surfaces.find(Eigen::Vector3d::UnitZ(), 1e-6));
  surfaces.clear();
  CHECK_FALSE(surfaces.full());
  CHECK_FALSE(surfaces.find(Eigen::Vector3d::UnitZ(), 1e-6));
  CHECK(allocation_count() == before);
}

}  // namespace isobar::test::test_level_surfaces
