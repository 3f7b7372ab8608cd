// SPDX-License-Identifier: BSD-3-Clause
// A building of boxes, as the map has it and as a standing robot sees it.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "core/map/map_point.hpp"
#include "core/place/known_map.hpp"
#include "core/place/place_query.hpp"
#include "tests/core/registration/synthetic_world.hpp"

namespace isobar::test {

/// Rooms seen from inside, and obstacles seen from outside.
class Building {
 public:
  void add_room(const Eigen::Vector3d& low, const Eigen::Vector3d& high, unsigned open_faces = 0);
  void add_obstacle(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

  /// Points of all walls and floors, 0.1 m apart.
  [[nodiscard]] std::vector<MapPoint> points() const;
  [[nodiscard]] KnownMap map() const;
  /// Points that a robot at `T_map_level` sees, in its level frame. Its lidar is 0.6 m above base_link, with a noise of 1 cm.
  [[nodiscard]] std::vector<Eigen::Vector3f> seen_from(const Eigen::Isometry3d& T_map_level) const;
  /// The same as a query.
  void look(const Eigen::Isometry3d& T_map_level, PlaceQuery& query) const;

  /// A face of a box: of the plane across `axis` the rectangle from `low` to `high`.
  struct Face {
    int axis;
    Eigen::Vector3d low;
    Eigen::Vector3d high;
    Eigen::Vector3d normal;  ///< towards those who see it
  };

 private:
  void add_faces(const Eigen::Vector3d& low, const Eigen::Vector3d& high, unsigned open_faces, double sign);

  World world_;
  std::vector<Face> faces_;
};

/// Level pose: heading and position.
[[nodiscard]] Eigen::Isometry3d level_pose_at(double x_m, double y_m, double z_m, double yaw_deg);

/// Two rooms that differ, joined by a door, with furniture.
[[nodiscard]] Building office();

}  // namespace isobar::test
