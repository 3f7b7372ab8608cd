// SPDX-License-Identifier: BSD-3-Clause
// What a standing robot sees at a place of a simulated world, with sensor errors of its own.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "simulation/random.hpp"
#include "simulation/scenario.hpp"

namespace isobar {

/// Scans of a VLP-16 at `T_world_base`, seconds apart in a world whose people and cars are those of `time_s`.
struct SimulatedPlace {
  Eigen::Isometry3d T_world_base;
  double time_s = 0.0;
  int scans = 1;
};

/// Levelled points of the scans, as a robot has them whose gravity is off by 0.2 degrees and whose lidar's mount by 0.05
/// degrees; ranges have a noise of 1.5 cm and a bias of 1 cm a laser.
struct LevelledScans {
  std::vector<std::vector<Eigen::Vector3f>> p_level;  ///< a scan each
  Eigen::Vector3f p_level_lidar;
  Eigen::Matrix3d R_level_base;  ///< as the robot believes
};
[[nodiscard]] LevelledScans scans_at(const simulation::Scenario& scenario, const SimulatedPlace& place,
                                     simulation::Random& random);

/// Share of the rays of an exact lidar in the empty world whose ranges at two poses differ by more than 10 cm, 0 … 1: that of
/// places that no lidar tells apart is near 0.
[[nodiscard]] double different_share(const simulation::Scenario& scenario,
                                     const Eigen::Isometry3d& T_world_one,
                                     const Eigen::Isometry3d& T_world_other);

}  // namespace isobar
