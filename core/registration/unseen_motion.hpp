// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "core/prior/prior_history.hpp"
#include "core/registration/known_place.hpp"

namespace isobar {

/// Unseen motion below which a robot stood, and the error of its pose then, 1 sigma.
inline constexpr double kStoodM = 0.15;
inline constexpr double kStoodRad = 0.1;

/// Pose where a robot is expected that was at `place` when its last process ended, and the motion that nobody saw.
struct ExpectedPlace {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();  ///< roll and pitch are those of the place
  double unseen_m = 0.0;                                         ///< horizontal
  double unseen_rad = 0.0;
  /// The robot stood when its last process ended, a short time ago, and has wheels: it is still there.
  bool stood = false;
};

/// Planar dead reckoning from a place to the newest prior: at constant speed and yaw rate until the first prior of
/// this process, where the pause is short; from then on by the gyro and, where it has them, the wheels.
/// Precondition: !priors.empty()
[[nodiscard]] ExpectedPlace expected_place(const KnownPlace& place, const PriorHistory& priors);

}  // namespace isobar
