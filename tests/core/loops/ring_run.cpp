// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/loops/ring_run.hpp"

#include <cmath>
#include <numbers>

#include "core/so3.hpp"

namespace isobar::test {
namespace {

constexpr double kEastM = 12.0;
constexpr double kNorthM = 9.0;
constexpr double kHalfWidthM = 1.2;
constexpr double kCeilingM = 2.6;
constexpr double kBaseM = 0.6;
constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

}  // namespace

World ring_of_corridors() {
  World world;
  world.add_box({-kHalfWidthM, -kHalfWidthM, 0.0}, {kEastM + kHalfWidthM, kNorthM + kHalfWidthM, kCeilingM});
  world.add_box({kHalfWidthM, kHalfWidthM, 0.0}, {kEastM - kHalfWidthM, kNorthM - kHalfWidthM, kCeilingM});
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  for (double x = 1.5; x < kEastM - 1.5; x += uniform(1.5, 2.5)) {
    const double high_m = uniform(0.8, 2.2);
    world.add_box({x, -kHalfWidthM, 0.0}, {x + uniform(0.4, 0.9), -kHalfWidthM + uniform(0.2, 0.4), high_m});
    world.add_box({x + 0.4, kNorthM + kHalfWidthM - uniform(0.2, 0.4), 0.0},
                  {x + uniform(0.8, 1.3), kNorthM + kHalfWidthM, high_m});
  }
  for (double y = 1.5; y < kNorthM - 1.5; y += uniform(1.5, 2.5)) {
    const double high_m = uniform(0.8, 2.2);
    world.add_box({-kHalfWidthM, y, 0.0}, {-kHalfWidthM + uniform(0.2, 0.4), y + uniform(0.4, 0.9), high_m});
    world.add_box({kEastM + kHalfWidthM - uniform(0.2, 0.4), y + 0.4, 0.0},
                  {kEastM + kHalfWidthM, y + uniform(0.8, 1.3), high_m});
  }
  return world;
}

double share_on_walls(std::span<const MapPoint> points) {
  const World world = ring_of_corridors();
  std::size_t on = 0;
  for (const MapPoint& point : points) {
    const Eigen::Vector3d& p = point.p_map;
    bool near = false;
    for (int axis = 0; axis < 3 && !near; ++axis) {
      const Eigen::Vector3d step = Eigen::Vector3d::Unit(axis);
      // From 5 cm before the point to 5 cm behind it.
      near = world.range(p - 0.05 * step, step) <= 0.1;
    }
    on += near ? 1 : 0;
  }
  return static_cast<double>(on) / static_cast<double>(points.size());
}

// Position and heading of a robot whose middle cuts the corners by half a metre: it turns over the last and the first
// half metre of each side.
Eigen::Isometry3d ring_pose(double way_m) {
  double along = std::fmod(way_m, kRingM);
  Eigen::Vector3d p(0.0, 0.0, kBaseM);
  double yaw = 0.0;
  for (int side = 0; side < 4; ++side) {
    const double length = side % 2 == 0 ? kEastM : kNorthM;
    const double driven = std::min(along, length);
    p += driven * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0);
    if (along <= length) {
      constexpr double kTurnM = 0.75;
      double turned = 0.0;
      if (length - along < kTurnM) turned = 0.5 * (1.0 - (length - along) / kTurnM);
      if (along < kTurnM) turned = -0.5 * (1.0 - along / kTurnM);
      yaw += turned * std::numbers::pi / 2.0;
      break;
    }
    along -= length;
    yaw += std::numbers::pi / 2.0;
  }
  return Eigen::Translation3d(p) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

const RegisteredScan& RingRun::next() {
  // Rays and returns of a robot that stands for the scan: registered scans are free of motion.
  const Eigen::Isometry3d T_world_base = ring_pose(way_m_);
  const std::int64_t stamp_ns = kStartNs + static_cast<std::int64_t>(way_m_ * 1e9);
  scan_world(
      world_, [&](std::int64_t) { return T_world_base; }, lidar_mount(), stamp_ns, 0.01, random_, *scan_);
  out_->pose = PoseEstimate{};
  out_->pose.stamp_ns = stamp_ns;
  out_->pose.mode = PoseMode::kRegistered;
  out_->pose.overlap = 0.9;
  out_->pose.covariance.setIdentity();
  out_->pose.T_map_base = error_ ? error_(way_m_) * T_world_base : T_world_base;
  out_->pose.on_known_ground = way_m_ >= known_from_m;
  out_->point_count = scan_->point_count;
  for (std::uint32_t i = 0; i < scan_->point_count; ++i) {
    ScanPoint point = scan_->points[i];
    point.z_m += static_cast<float>(lidar_mount().translation().z());
    out_->points[i] = point;
  }
  way_m_ += step_m;
  return *out_;
}

}  // namespace isobar::test
