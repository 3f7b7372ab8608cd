// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/registration/synthetic_world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
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
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      if ((open_faces >> static_cast<unsigned>(2 * axis + side) & 1U) == 0U) {
        const Face face{side == 0 ? lowest[axis] : highest[axis], lowest[u], highest[u], lowest[v],
                        highest[v]};
        std::vector<Face>& faces = faces_[static_cast<std::size_t>(axis)];
        const auto next = std::upper_bound(faces.begin(), faces.end(), face,
                                           [](const Face& a, const Face& b) { return a.place < b.place; });
        faces.insert(next, face);
      }
    }
  }
}

double World::range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double from = origin[axis];
    const double from_u = origin[u];
    const double from_v = origin[v];
    const double along = direction[axis];
    const double along_u = direction[u];
    const double along_v = direction[v];
    // In the order in which the ray comes to them, up to the nearest face so far.
    const auto passes = [&](const Face& face) {
      const double t = (face.place - from) / along;
      if (!(t < nearest)) return false;
      const double at_u = from_u + t * along_u;
      const double at_v = from_v + t * along_v;
      const bool inside =
          at_u >= face.lowest_u && at_u <= face.highest_u && at_v >= face.lowest_v && at_v <= face.highest_v;
      if (inside && t > 1e-6) nearest = t;
      return true;
    };
    const std::vector<Face>& faces = faces_[static_cast<std::size_t>(axis)];
    const auto ahead = std::partition_point(faces.begin(), faces.end(),
                                            [&](const Face& face) { return face.place <= from; });
    if (along > 0.0) {
      for (auto face = ahead; face != faces.end() && passes(*face);) ++face;
    } else if (along < 0.0) {
      for (auto face = ahead; face != faces.begin() && passes(*std::prev(face));) --face;
    }
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

namespace {

/// Directions of one revolution in axes of the lidar, by column and ring.
const std::vector<Eigen::Vector3d>& beam_directions() {
  static const std::vector<Eigen::Vector3d> directions = [] {
    std::vector<Eigen::Vector3d> all;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * std::numbers::pi * column / kColumns;
      for (int ring = 0; ring < kRings; ++ring) {
        const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
        all.emplace_back(std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation));
      }
    }
    return all;
  }();
  return directions;
}

}  // namespace

void scan_world(const World& world, const Motion& motion, const Eigen::Isometry3d& T_base_lidar,
                std::int64_t stamp_ns, double noise_m, std::mt19937& random, Scan& scan) {
  std::normal_distribution<double> noise(0.0, 1.0);
  scan.stamp_ns = stamp_ns;
  scan.end_stamp_ns = stamp_ns + kRevolutionNs;
  scan.packets_lost = 0;
  scan.point_count = 0;
  auto beam = beam_directions().begin();
  for (int column = 0; column < kColumns; ++column) {
    const std::int64_t time_4us = kRevolutionNs / kPointTimeUnitNs * column / kColumns;
    const Eigen::Isometry3d T_world_lidar = motion(stamp_ns + time_4us * kPointTimeUnitNs) * T_base_lidar;
    const Eigen::Vector3d origin = T_world_lidar.translation();
    const Eigen::Matrix3d R_world_lidar = T_world_lidar.linear();
    for (int ring = 0; ring < kRings; ++ring) {
      const Eigen::Vector3d& direction = *beam++;
      const double range = world.range(origin, R_world_lidar * direction);
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
