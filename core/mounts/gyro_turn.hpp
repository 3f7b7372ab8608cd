// SPDX-License-Identifier: BSD-3-Clause
// Turn of the robot by the gyro alone. The attitude of the priors is not used for it: its corrections by gravity,
// tenths of a degree in a turn, look like a mount.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/prior/prior_history.hpp"

namespace isobar {

/// Rotation base(from) <- base(to), the integral of Prior::w_base_rad_s by trapezoids. False, and `turn` unchanged,
/// where the priors do not cover the time without gaps, or gravity is unknown (the bias of the gyro is, too).
/// Takes as long as there are priors after `from_ns`.
bool gyro_turn(const PriorHistory& history, std::int64_t from_ns, std::int64_t to_ns,
               Eigen::Quaterniond& turn);

}  // namespace isobar
