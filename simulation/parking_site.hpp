// SPDX-License-Identifier: BSD-3-Clause
// A parking garage: level decks joined by a helical ramp.
#pragma once

#include <numbers>

#include "simulation/mesh.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// Dimensions of a garage. The axis of the ramp is the z axis; its lane turns to the left as it rises. Each deck
/// lies beyond the lane towards +x and joins it where the lane is level, around angle 0.
struct ParkingSizes {
  static constexpr double kHalfLaneM = 2.0;
  static constexpr double kFlatRad = 37.5 * std::numbers::pi / 180.0;  ///< half of the level sector

  int top = 4;                ///< number of the uppermost deck; the lowest is 0
  double storey_m = 3.0;      ///< floor to floor
  double radius_m = 9.0;      ///< of the lane's centre line
  double deck_m = 28.0;       ///< length of a deck along x
  double deck_half_m = 12.0;  ///< half of its width along y

  [[nodiscard]] static ParkingSizes draw(Random& random, int top);
  [[nodiscard]] double inner_m() const { return radius_m - kHalfLaneM; }
  [[nodiscard]] double outer_m() const { return radius_m + kHalfLaneM; }
  /// x of the border between lane and decks.
  [[nodiscard]] double deck_start_m() const;
  /// Height of the lane at an angle around the axis, which grows by a full turn a storey [rad].
  [[nodiscard]] double lane_m(double angle_rad) const;
};

/// Lane, decks, walls, parapets, pillars and parked cars.
[[nodiscard]] Mesh build_parking(const ParkingSizes& sizes, Random& random);

}  // namespace isobar::simulation
