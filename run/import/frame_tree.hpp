// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "run/import/ros_messages.hpp"

namespace isobar::imports {

/// Frames of /tf_static and /tf, with the first transform seen of each: mounts of sensors.
class FrameTree {
 public:
  void add(const std::vector<StampedPose>& transforms);
  /// Transform of `frame` in `base`, through any common ancestor; nothing where they are not connected.
  [[nodiscard]] std::optional<Eigen::Isometry3d> find(const std::string& base,
                                                      const std::string& frame) const;
  [[nodiscard]] bool holds(const std::string& frame) const;
  [[nodiscard]] bool empty() const { return parents_.empty(); }

 private:
  struct Parent {
    std::string name;
    Eigen::Isometry3d T_parent_child;
  };
  /// Transforms of a frame in itself and its ancestors, nearest first.
  [[nodiscard]] std::vector<std::pair<std::string, Eigen::Isometry3d>> ancestors(
      const std::string& start) const;

  std::map<std::string, Parent> parents_;  // by child
};

}  // namespace isobar::imports
