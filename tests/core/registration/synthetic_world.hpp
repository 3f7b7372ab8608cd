// SPDX-License-Identifier: BSD-3-Clause
// A small world of rectangles, a VLP-16 that moves through it while it scans, and priors along the way.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "core/estimates.hpp"

namespace isobar::test {

/// Pose of base_link in the world at a time.
using Motion = std::function<Eigen::Isometry3d(std::int64_t stamp_ns)>;

/// Faces of axis-aligned boxes.
class World {
 public:
  /// Six faces; a robot inside sees them as a room, one outside as an obstacle. Faces can be left out by
  /// giving them a bit in `open_faces`: 1 -x, 2 +x, 4 -y, 8 +y, 16 -z, 32 +z.
  void add_box(const Eigen::Vector3d& lowest, const Eigen::Vector3d& highest, unsigned open_faces = 0);

  /// Distance along the unit `direction` to the next face; infinity where there is none.
  [[nodiscard]] double range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

 private:
  struct Face {
    int axis;
    double place;
    Eigen::Vector3d lowest;
    Eigen::Vector3d highest;
  };
  std::vector<Face> faces_;
};

/// A room of 10 x 8 x 3 m with a few boxes.
World furnished_room();
/// A corridor of 2.4 x 2.6 m along x without ends or features.
World bare_corridor();

/// Fills `scan` with one revolution of 16 beams from `stamp_ns` on, 0.1 s long, each point measured at its
/// own time from where the lidar was then. Deterministic for a given state of `random`.
void scan_world(const World& world, const Motion& motion, const Eigen::Isometry3d& T_base_lidar,
                std::int64_t stamp_ns, double noise_m, std::mt19937& random, Scan& scan);

/// The prior that a perfect dead reckoning with wheels, whose odom frame is the world, has at `stamp_ns`.
Prior perfect_prior(const Motion& motion, std::int64_t stamp_ns);

}  // namespace isobar::test
