// SPDX-License-Identifier: BSD-3-Clause
// The pose of a standing robot is held: scan by scan, a registration would follow its own map, whose cells hold more than
// one surface, by millimetres.
#pragma once

#include <Eigen/Geometry>

namespace isobar {

/// Judges whether a registration of a robot that may stand (Prior::may_stand) is the held pose with the error of one scan,
/// or motion that no other sensor feels: without wheels, a robot lowered on a rope.
class HeldPose {
 public:
  /// `T_held`, `T_match`: T_map_base before the scan, and as the scan has it.
  [[nodiscard]] bool holds(bool may_stand, const Eigen::Isometry3d& T_held, const Eigen::Isometry3d& T_match);
  /// False for a held scan that the map must not take: it would creep with a robot that creeps, and hide it.
  [[nodiscard]] bool for_map(bool wheels_stand) const;

 private:
  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();        // of the last scan from the held pose
  Eigen::Vector3d first_offset_m_ = Eigen::Vector3d::Zero();  // mean of the first scans held
  int scans_ = 0;
  bool steady_ = false;
};

}  // namespace isobar
