// SPDX-License-Identifier: BSD-3-Clause
// A robot on its rounds through a ring of corridors: registered scans, with a live pose that may be wrong.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <utility>

#include "core/estimates.hpp"
#include "core/map/map_point.hpp"
#include "tests/core/registration/synthetic_world.hpp"

namespace isobar::test {

/// A ring of corridors, 12 m x 9 m along its middle line, with cupboards that make each place unlike the others.
World ring_of_corridors();
inline constexpr double kRingM = 42.0;

/// Share of points [m] of a map that are within 5 cm of a surface of the ring.
double share_on_walls(std::span<const MapPoint> points);

/// True pose after `way_m` of the ring, anticlockwise from its south-west corner, at 0.6 m above the floor.
Eigen::Isometry3d ring_pose(double way_m);

/// Error of the live pose after a way: the live pose is error * truth.
using LiveError = std::function<Eigen::Isometry3d(double way_m)>;

/// Makes the scans of a drive along the ring at 1 m/s.
class RingRun {
 public:
  explicit RingRun(LiveError error = {}, World world = ring_of_corridors())
      : error_(std::move(error)), world_(std::move(world)) {}

  /// The next scan with its live pose, valid until the next call.
  const RegisteredScan& next();
  /// The live pose counts as on known ground from here on [m]: from the start, so that the chain registers every key scan.
  double known_from_m = 0.0;
  /// Way between two scans.
  double step_m = 0.4;
  /// Way of the last scan.
  [[nodiscard]] double way_m() const { return way_m_ - step_m; }
  /// The robot is carried on by `way_m`, without scans.
  void carry(double way_m) { way_m_ += way_m; }
  [[nodiscard]] static Eigen::Isometry3d lidar_mount() {
    return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.2));
  }

 private:
  LiveError error_;
  World world_;
  double way_m_ = 0.0;
  std::mt19937 random_{7};
  std::unique_ptr<Scan> scan_ = std::make_unique<Scan>();
  std::unique_ptr<RegisteredScan> out_ = std::make_unique<RegisteredScan>();
};

}  // namespace isobar::test
