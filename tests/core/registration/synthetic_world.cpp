// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/registration/synthetic_world.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace isobar::test {

namespace {
constexpr std::int64_t kRevolutionNs = 100'000'000;
constexpr int kColumns = 600;
constexpr int kRings = 16;
}  // namespace

void World::add_box(const Eigen::Vector3d& lowest, const Eigen::Vector3d& highest, unsigned open_faces) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      if ((open_faces >> static_cast<unsigned>(2 * axis + side) & 1U) == 0U) {
        faces_.push_back({axis, side == 0 ? lowest[axis] : highest[axis], lowest, highest});
      }
    }
  }
}

double World::range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Face& face : faces_) {
    const double t = (face.place - origin[face.axis]) / direction[face.axis];
    if (!(t > 1e-6 && t < nearest)) {
      continue;
    }
    const Eigen::Vector3d p = origin + t * direction;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      inside =
          inside && (axis == face.axis || (p[axis] >= face.lowest[axis] && p[axis] <= face.highest[axis]));
    }
    nearest = inside ? t : nearest;
  }
  return nearest;
}

World furnished_room() {
  World world;
  world.add_box({-5.0, -4.0, 0.0}, {5.0, 4.0, 3.0});
  world.add_box({2.0, 2.0, 0.0}, {3.0, 3.2, 1.8});
  world.add_box({-4.2, -3.0, 0.0}, {-3.0, -1.8, 1.2});
  world.add_box({3.5, -2.5, 0.0}, {4.0, -1.5, 2.2});
  return world;
}

World bare_corridor() {
  World world;
  world.add_box({-300.0, -1.2, 0.0}, {300.0, 1.2, 2.6}, 1U | 2U);
  return world;
}

void scan_world(const World& world, const Motion& motion, const Eigen::Isometry3d& T_base_lidar,
                std::int64_t stamp_ns, double noise_m, std::mt19937& random, Scan& scan) {
  std::normal_distribution<double> noise(0.0, 1.0);
  scan.stamp_ns = stamp_ns;
  scan.end_stamp_ns = stamp_ns + kRevolutionNs;
  scan.packets_lost = 0;
  scan.point_count = 0;
  for (int column = 0; column < kColumns; ++column) {
    const std::int64_t time_4us = kRevolutionNs / kPointTimeUnitNs * column / kColumns;
    const Eigen::Isometry3d T_world_lidar = motion(stamp_ns + time_4us * kPointTimeUnitNs) * T_base_lidar;
    const double azimuth = 2.0 * std::numbers::pi * column / kColumns;
    for (int ring = 0; ring < kRings; ++ring) {
      const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      -std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range = world.range(T_world_lidar.translation(), T_world_lidar.linear() * direction);
      if (!(range < 100.0)) {
        continue;
      }
      const Eigen::Vector3f p = (direction * (range + noise_m * noise(random))).cast<float>();
      scan.points[scan.point_count++] = {
          p.x(), p.y(), p.z(), static_cast<std::uint16_t>(time_4us), static_cast<std::uint8_t>(ring), 50};
    }
  }
}

Prior perfect_prior(const Motion& motion, std::int64_t stamp_ns) {
  Prior prior;
  prior.stamp_ns = stamp_ns;
  prior.T_odom_base = motion(stamp_ns);
  prior.height_m = prior.T_odom_base.translation().z();
  prior.height_variance_m2 = 1e-4;
  prior.height_source = HeightSource::kDifferential;
  prior.roll_pitch_variance_rad2 = 1e-5;
  prior.yaw_rate_variance_rad2_s2 = 1e-5;
  prior.velocity_variance_m2_s2 = 1e-2;
  prior.attitude_valid = true;
  prior.velocity_valid = true;
  return prior;
}

}  // namespace isobar::test
