// SPDX-License-Identifier: BSD-3-Clause
// Twist of a robot from the turning of its wheels, without I/O.
#pragma once

#include <cstdint>

#include "core/samples.hpp"

namespace isobar::encoder {

/// How a robot turns by a difference of its sides.
enum class Drive : std::uint8_t {
  kDifferential,  ///< two driven wheels: the track width is that between their contacts
  kSkidSteer,     ///< wheels that are dragged sideways in a turn: the effective track is wider
  kTracked,       ///< tracks, the same
};

struct Geometry {
  Drive drive = Drive::kDifferential;
  double wheel_radius_m = 0.1;       ///< of a wheel, or the pitch radius of a track's sprocket
  double counts_per_turn = 2'000.0;  ///< of a wheel: four times the encoder's periods, times the gear ratio
  double track_width_m = 0.5;        ///< between the middles of the sides
  /// Effective track width over track_width_m, at least 1; without a meaning for kDifferential. A turn in
  /// place by a known angle shows it: typically 1.3 … 2 on hard floors (instantaneous centres of rotation of
  /// the tracks: Martínez et al. 2005).
  double track_factor = 1.5;
};

/// Way of a count [m].
[[nodiscard]] double count_m(const Geometry& geometry) noexcept;

/// Width by which a difference of the sides turns the robot [m].
[[nodiscard]] double effective_track_m(const Geometry& geometry) noexcept;

/// Mean twist over a time, in base_link: vx = (right + left) / 2, wz = (right - left) / effective track, of
/// the sides' speeds; vy is 0. Times the time it is the way of the counts, none is lost.
/// @param left_counts,right_counts of a side in this time, mean of its wheels, forward positive
/// @param dt_s above 0
/// @return stamp_ns 0
[[nodiscard]] WheelSample twist(const Geometry& geometry, double left_counts, double right_counts,
                                double dt_s) noexcept;

}  // namespace isobar::encoder
