// SPDX-License-Identifier: BSD-3-Clause
// Synthetic world of boxes, a VLP-16 that scans it in motion, and priors of the same motion.
#pragma once

#include <Eigen/Geometry>
#include <array>
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
  /// Six faces: a room from inside, an obstacle from outside. Bits of `open_faces` leave faces out: 1 -x, 2
  /// +x, 4 -y, 8 +y, 16 -z, 32 +z.
  void add_box(const Eigen::Vector3d& lowest, const Eigen::Vector3d& highest, unsigned open_faces = 0);

  /// Distance along the unit vector `direction` to the next face [m]; infinity where there is none.
  [[nodiscard]] double range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

 private:
  /// Face across an axis, bounded on the two others. Plain numbers: sanitizers make a ray through Eigen 20 times as slow.
  struct Face {
    double place;
    double lowest_u;
    double highest_u;
    double lowest_v;
    double highest_v;
  };
  std::array<std::vector<Face>, 3> faces_;  // by axis, in order of their places
};

/// A room of 10 x 8 x 3 m with a few boxes.
World furnished_room();
/// A corridor of 2.4 x 2.6 m along x without ends or features.
World bare_corridor();

/// Fills `scan` with one revolution of 16 beams of 0.1 s from `stamp_ns` on; each point is measured from the
/// lidar's pose at its own time. Deterministic for a given state of `random`.
void scan_world(const World& world, const Motion& motion, const Eigen::Isometry3d& T_base_lidar,
                std::int64_t stamp_ns, double noise_m, std::mt19937& random, Scan& scan);

/// Prior of perfect dead reckoning with wheels at `stamp_ns`; its odom frame is the world.
Prior perfect_prior(const Motion& motion, std::int64_t stamp_ns);

}  // namespace isobar::test
