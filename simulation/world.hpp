// SPDX-License-Identifier: BSD-3-Clause
// World as seen by the lidar: a static mesh and moving bodies.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/ray_caster.hpp"
#include "simulation/spline.hpp"

namespace isobar::simulation {

/// Rigid body that translates without rotating: a walking person, the cabin of an elevator, a sliding door.
struct MovingBody {
  RayCaster shape;  ///< in the body's own frame
  Channel x_m;      ///< position of that frame in the world, on the time grid of the scenario
  Channel y_m;
  Channel z_m;
  std::size_t first = 0;  ///< raw sample of the scenario at which the channels start; the body exists only
                          ///< from there to their end
};

/// Immutable: any number of threads may cast rays at any times.
class World {
 public:
  World() = default;
  World(const Mesh& standing, std::vector<MovingBody> moving);

  /// Adds bodies on the time grid of the others.
  void add(std::vector<MovingBody> moving);
  /// Everything that does not move.
  [[nodiscard]] const RayCaster& standing() const { return standing_; }

  /// Positions of the bodies at one time.
  struct Moment {
    struct Body {
      Eigen::Vector3d origin;
      Eigen::Vector3f centre;  ///< of the bounding sphere
      float radius_m;          ///< of the bounding sphere
      const RayCaster* shape;
    };
    std::vector<Body> bodies;
  };

  /// Sets `moment` to the bodies that may be within `range_m` of `eye` at `time_s`; reuses its memory.
  void look(double time_s, const Eigen::Vector3d& eye, double range_m, Moment& moment) const;
  /// Nearest hit of the static mesh and the bodies of `moment`.
  [[nodiscard]] Hit cast(const Moment& moment, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, double limit_m) const;

 private:
  RayCaster standing_;
  std::vector<MovingBody> moving_;
  std::size_t samples_ = 0;  ///< raw samples up to the end of the last body
};

}  // namespace isobar::simulation
