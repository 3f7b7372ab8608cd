// SPDX-License-Identifier: BSD-3-Clause
// Ground outdoors: hills.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// Smooth ground: a sum of four long sine waves with height 0 at the origin.
class Terrain {
 public:
  static constexpr double kSteepest = 0.06;  ///< maximum slope of a city's streets, rise over run

  /// Hills of a city, 180 to 1300 m long.
  explicit Terrain(Random random) : Terrain(random, kSteepest, 1.0) {}
  /// @param steepest bound of the slope, rise over run; the random waves reach two thirds of it or more
  /// @param scale length of the hills relative to those of a city
  Terrain(Random random, double steepest, double scale);

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

/// Sets height, pitch and roll of poses in plan to those of the terrain.
void drape(std::vector<RawPose>& poses, const Terrain& terrain);

}  // namespace isobar::simulation
