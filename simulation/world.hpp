// SPDX-License-Identifier: BSD-3-Clause
// What the lidar sees: triangles that stand still and bodies that move.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/ray_caster.hpp"
#include "simulation/spline.hpp"

namespace isobar::simulation {

/// A rigid body that moves without turning: a walking person, an elevator's cabin, a sliding door.
struct MovingBody {
  RayCaster shape;  ///< in the body's own frame
  Channel x_m;      ///< where its frame is, on the time grid of the scenario
  Channel y_m;
  Channel z_m;
  std::size_t first = 0;  ///< raw sample of the scenario that its channels begin with: it is there from then
                          ///< until they end
};

/// Immutable; any number of threads may cast at any times.
class World {
 public:
  World() = default;
  World(const Mesh& standing, std::vector<MovingBody> moving);

  /// Where the bodies are at one time.
  struct Moment {
    struct Body {
      Eigen::Vector3d origin;
      Eigen::Vector3f centre;  ///< of a sphere around it
      float radius_m;
      const RayCaster* shape;
    };
    std::vector<Body> bodies;
  };

  /// Positions of the bodies at time_s that may be within range_m of `eye`. Reuses the memory of `moment`.
  void look(double time_s, const Eigen::Vector3d& eye, double range_m, Moment& moment) const;
  /// Nearest hit among the standing triangles and the bodies of `moment`.
  [[nodiscard]] Hit cast(const Moment& moment, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, double limit_m) const;

 private:
  RayCaster standing_;
  std::vector<MovingBody> moving_;
  std::size_t samples_ = 0;  ///< of the scenario, as far as bodies are there
};

}  // namespace isobar::simulation
