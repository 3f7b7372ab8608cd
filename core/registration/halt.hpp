// SPDX-License-Identifier: BSD-3-Clause
// A halt, as one prior shows it. Prior::standing_still is the result of a longer look.
#pragma once

#include "core/estimates.hpp"

namespace isobar {

/// The wheels stand; the ground may carry the robot, as in an elevator.
[[nodiscard]] inline bool wheels_stand(const Prior& prior) {
  constexpr double kHaltMS = 0.01;
  return prior.velocity_valid && prior.v_base_m_s.norm() < kHaltMS;
}

/// The wheels stand and the gyro feels no turn beyond a bias.
[[nodiscard]] inline bool halts(const Prior& prior) {
  constexpr double kHaltRadS = 0.03;
  return prior.attitude_valid && wheels_stand(prior) && prior.w_base_rad_s.norm() < kHaltRadS;
}

}  // namespace isobar
