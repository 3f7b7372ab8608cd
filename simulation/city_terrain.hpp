// SPDX-License-Identifier: BSD-3-Clause
// Hills under a city.
#pragma once

#include <Eigen/Core>
#include <array>

#include "simulation/random.hpp"

namespace isobar::simulation {

/// Smooth ground: a sum of long waves, 0 at the origin, nowhere steeper than kSteepest.
class CityTerrain {
 public:
  static constexpr double kSteepest = 0.06;  ///< rise over run

  explicit CityTerrain(Random random);

  [[nodiscard]] double height_m(const Eigen::Vector2d& at_m) const;
  /// Rise over run towards +x and +y.
  [[nodiscard]] Eigen::Vector2d slope(const Eigen::Vector2d& at_m) const;

 private:
  struct Wave {
    Eigen::Vector2d number_1_m = Eigen::Vector2d::Zero();  ///< radians a metre
    double height_m = 0.0;
    double phase_rad = 0.0;
  };
  std::array<Wave, 4> waves_;
};

}  // namespace isobar::simulation
