// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "run/evaluation/trajectory.hpp"

namespace isobar::evaluation {

/// An estimate and its reference.
struct Session {
  const Trajectory& reference;
  const Trajectory& estimate;
};

/// Errors of a second session in the map frame of the first one. No alignment of its own: a session whose frame is another
/// one shows it.
struct SecondSessionError {
  std::size_t poses = 0;  ///< compared
  double position_rms_m = 0.0;
  double position_max_m = 0.0;
  double yaw_rms_rad = 0.0;
  double yaw_max_rad = 0.0;
};

/// The map frame in the reference's is that of the first session's trajectory, by least squares of x, y, z and yaw. Both
/// references are in one frame. All zero where nothing can be compared.
[[nodiscard]] SecondSessionError second_session_error(const Session& first, const Session& second);

}  // namespace isobar::evaluation
