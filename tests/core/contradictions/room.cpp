// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/contradictions/room.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar::test {

namespace {

double wall_distance(const Room& room, const Eigen::Vector2d& p, const Eigen::Vector2d& d) {
  double nearest = 1e9;
  const auto hit = [&](double along, double to) {
    if (std::abs(along) > 1e-9 && to / along > 0.0) nearest = std::min(nearest, to / along);
  };
  hit(d.x(), room.east - p.x());
  hit(d.x(), room.west - p.x());
  hit(d.y(), room.north - p.y());
  hit(d.y(), room.south - p.y());
  return nearest;
}

}  // namespace

void scan_room(const Room& room, const Eigen::Isometry2d& T_room_base, const Eigen::Matrix3d& R_base_lidar,
               std::int64_t end_ns, Scan& scan) {
  constexpr int kRings = 16;
  constexpr int kAzimuths = 900;
  scan.stamp_ns = end_ns - 100'000'000;
  scan.end_stamp_ns = end_ns;
  scan.point_count = 0;
  for (int a = 0; a < kAzimuths; ++a) {
    const double azimuth = 2.0 * kPi * a / kAzimuths;
    const Eigen::Vector2d d = T_room_base.linear() * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
    const double range_m = wall_distance(room, T_room_base.translation(), d);
    for (int ring = 0; ring < kRings; ++ring) {
      const double slope = std::tan((2.0 * ring - 15.0) * kRadPerDeg);
      const Eigen::Vector3d p_base(range_m * std::cos(azimuth), range_m * std::sin(azimuth), range_m * slope);
      const Eigen::Vector3f p = (R_base_lidar.transpose() * p_base).cast<float>();
      scan.points[scan.point_count++] = {p.x(), p.y(), p.z(), 0, static_cast<std::uint8_t>(ring), 50};
    }
  }
}

}  // namespace isobar::test
