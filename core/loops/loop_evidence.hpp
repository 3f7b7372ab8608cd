// SPDX-License-Identifier: BSD-3-Clause
// Loops that wait for a second one: a place that looks alike once does so again only where it is the same place.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/loops/loop.hpp"

namespace isobar {

/// A loop, and how far it moves the robot.
struct LoopEvidence {
  Loop loop;
  Eigen::Vector4d shift = Eigen::Vector4d::Zero();  ///< of the robot, by the loop: x, y, z [m], yaw [rad]
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
};

/// Accepts loops in pairs: two that were measured apart from each other and move the robot alike.
class LoopPairs {
 public:
  /// Way between the two loops of a pair [m]: below, they share what misleads them; above, the robot has drifted.
  static constexpr double kLeastWayM = 1.5;
  static constexpr double kMostWayM = 15.0;

  /// Takes a loop.
  /// @return the loops that are accepted now: none, this one, or this one and those that waited
  std::vector<Loop> add(const LoopEvidence& evidence);
  /// The graph has moved: loops from before are measured against poses that are no more.
  void clear() { waiting_.clear(); }

 private:
  struct Waiting {
    LoopEvidence evidence;
    bool accepted = false;
  };
  std::vector<Waiting> waiting_;
};

}  // namespace isobar
