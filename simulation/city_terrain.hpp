// SPDX-License-Identifier: BSD-3-Clause
// Ground of a city: hills.
#pragma once

#include <Eigen/Core>
#include <array>

#include "simulation/random.hpp"

namespace isobar::simulation {

/// Smooth ground: a sum of four long sine waves with height 0 at the origin and slopes up to kSteepest.
class CityTerrain {
 public:
  static constexpr double kSteepest = 0.06;  ///< maximum slope, rise over run

  explicit CityTerrain(Random random);

  [[nodiscard]] double height_m(const Eigen::Vector2d& at_m) const;
  /// Gradient of the height: rise over run towards +x and +y.
  [[nodiscard]] Eigen::Vector2d slope(const Eigen::Vector2d& at_m) const;

 private:
  struct Wave {
    Eigen::Vector2d number_1_m = Eigen::Vector2d::Zero();  ///< wave vector [rad/m]
    double height_m = 0.0;                                 ///< amplitude
    double phase_rad = 0.0;
  };
  std::array<Wave, 4> waves_;
};

}  // namespace isobar::simulation
