// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/registration/deskew.hpp"
#include "core/so3.hpp"
#include "tests/core/registration/synthetic_world.hpp"

namespace isobar::test::test_deskew {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

Eigen::Isometry3d lidar_mount() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.2, 1.0, 0.1).normalized()).toRotationMatrix();
  T.translation() << 0.1, -0.05, 0.45;
  return T;
}

// Constant twist from a pose in the room: yaw 0.8 rad/s, some pitch, 0.9 m/s.
Eigen::Isometry3d twisting(std::int64_t stamp_ns) {
  const double t = static_cast<double>(stamp_ns - kStart) * 1e-9;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(0.8 * t, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.15 * t, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix();
  T.translation() << 0.9 * t, -0.3 * t, 0.6 + 0.2 * t;
  return T;
}

PriorHistory history_of(const Motion& motion) {
  PriorHistory history;
  for (std::int64_t t = -50'000'000; t <= 150'000'000; t += 5'000'000) {
    history.add(perfect_prior(motion, kStart + t));
  }
  return history;
}

// Largest distance of the deskewed points, placed at the end pose, to the walls of the static room.
double largest_distance_to_room(const RegisteredScan& out, const Eigen::Isometry3d& T_world_end) {
  double largest = 0.0;
  for (std::uint32_t i = 0; i < out.point_count; ++i) {
    const ScanPoint& point = out.points[i];
    const Eigen::Vector3d p = T_world_end * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    // An empty room of 10 x 8 x 3 m.
    const double to_wall = std::min({std::abs(std::abs(p.x()) - 5.0), std::abs(std::abs(p.y()) - 4.0),
                                     std::abs(p.z()), std::abs(p.z() - 3.0)});
    largest = std::max(largest, to_wall);
  }
  return largest;
}

// Deskews a whole scan.
void deskew(const Scan& scan, const PriorHistory& history, const ScanMotion& motion, Deskewer& deskewer,
            RegisteredScan& out) {
  deskewer.start(scan, history, motion);
  out.point_count = static_cast<std::uint32_t>(deskewer.move({scan.points, scan.point_count}, out.points));
}

World empty_room() {
  World world;
  world.add_box({-5.0, -4.0, 0.0}, {5.0, 4.0, 3.0});
  return world;
}

}  // namespace

TEST_CASE("a scan taken in motion becomes the cloud of the static room") {
  std::mt19937 random(1);
  auto scan = std::make_unique<Scan>();
  scan_world(empty_room(), twisting, lidar_mount(), kStart, 0.0, random, *scan);
  const PriorHistory history = history_of(twisting);
  ScanMotion motion;
  REQUIRE(history.at(scan->end_stamp_ns, motion.end));
  auto out = std::make_unique<RegisteredScan>();
  Deskewer deskewer(lidar_mount(), 0.3, 100.0);
  deskew(*scan, history, motion, deskewer, *out);
  CHECK(out->point_count == scan->point_count);
  // Knots are at most 128 us off: 0.1 mrad at 0.8 rad/s, 1 mm at 7 m, plus 0.1 mm of translation.
  CHECK(largest_distance_to_room(*out, twisting(scan->end_stamp_ns)) < 0.0015);
}

TEST_CASE("without gyro and wheels a scan is deskewed by the turn rate and the velocity of its motion") {
  std::mt19937 random(1);
  auto scan = std::make_unique<Scan>();
  scan_world(empty_room(), twisting, lidar_mount(), kStart, 0.0, random, *scan);
  PriorHistory history;  // of a robot that knows the time only
  for (int i = 0; i <= 10; ++i) {
    Prior prior;
    prior.stamp_ns = kStart + i * 20'000'000;
    history.add(prior);
  }
  const Eigen::Isometry3d T_end = twisting(scan->end_stamp_ns);
  const Eigen::Isometry3d T_before = twisting(scan->end_stamp_ns - 1'000'000);
  ScanMotion motion;
  REQUIRE(history.at(scan->end_stamp_ns, motion.end));
  motion.from_wheels = motion.turn_known = false;
  motion.v_base_m_s = T_end.linear().transpose() * (T_end.translation() - T_before.translation()) * 1e3;
  motion.w_base_rad_s = log_so3(Eigen::Quaterniond(T_before.linear().transpose() * T_end.linear())) * 1e3;
  auto out = std::make_unique<RegisteredScan>();
  Deskewer deskewer(lidar_mount(), 0.3, 100.0);
  deskew(*scan, history, motion, deskewer, *out);
  CHECK(largest_distance_to_room(*out, T_end) < 0.02);
  motion.turn_known = true;  // that it stands
  deskew(*scan, history, motion, deskewer, *out);
  CHECK(largest_distance_to_room(*out, T_end) > 0.1);
}

TEST_CASE("without wheels a scan is deskewed by constant velocity and the prior's rotation") {
  std::mt19937 random(1);
  auto scan = std::make_unique<Scan>();
  scan_world(empty_room(), twisting, lidar_mount(), kStart, 0.0, random, *scan);
  const Motion without_translation = [](std::int64_t stamp_ns) {
    Eigen::Isometry3d T = twisting(stamp_ns);
    T.translation().setZero();
    return T;
  };
  const PriorHistory history = history_of(without_translation);
  ScanMotion motion;
  REQUIRE(history.at(scan->end_stamp_ns, motion.end));
  motion.from_wheels = false;
  motion.v_base_m_s = twisting(scan->end_stamp_ns).linear().transpose() * Eigen::Vector3d(0.9, -0.3, 0.2);
  auto out = std::make_unique<RegisteredScan>();
  Deskewer deskewer(lidar_mount(), 0.3, 100.0);
  deskew(*scan, history, motion, deskewer, *out);
  CHECK(largest_distance_to_room(*out, twisting(scan->end_stamp_ns)) < 0.0015);
}

TEST_CASE("points out of range or not finite are dropped; absurd times of scan and points are tolerated") {
  auto scan = std::make_unique<Scan>();
  scan->stamp_ns = kStart;
  scan->end_stamp_ns = kStart + 100'000'000;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  scan->points[0] = {nan, 1.0F, 1.0F, 0, 0, 0};
  scan->points[1] = {infinity, 1.0F, 1.0F, 0, 0, 0};
  scan->points[2] = {0.1F, 0.0F, 0.0F, 0, 0, 0};
  scan->points[3] = {500.0F, 0.0F, 0.0F, 0, 0, 0};
  scan->points[4] = {3.0F, 4.0F, 0.0F, 65535, 0, 0};
  scan->point_count = 5;
  auto out = std::make_unique<RegisteredScan>();
  Deskewer deskewer(Eigen::Isometry3d::Identity(), 0.3, 100.0);
  ScanMotion motion;
  deskew(*scan, PriorHistory(), motion, deskewer, *out);
  REQUIRE(out->point_count == 1);
  CHECK(out->points[0].x_m == doctest::Approx(3.0F));
  // A scan that ends before it starts, or lasts a year.
  scan->end_stamp_ns = kStart - 5;
  deskew(*scan, PriorHistory(), motion, deskewer, *out);
  CHECK(out->point_count == 1);
  scan->end_stamp_ns = kStart + 31'536'000'000'000'000;
  deskew(*scan, PriorHistory(), motion, deskewer, *out);
  CHECK(out->point_count == 1);
}

}  // namespace isobar::test::test_deskew
