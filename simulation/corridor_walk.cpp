// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/corridor_walk.hpp"

#include <algorithm>
#include <cstddef>

namespace isobar::simulation {

using Eigen::Vector2d;

void append_walk(std::vector<Waypoint>& way, const Corridor& corridor, const CorridorWalk& walk,
                 Random& random) {
  std::vector<Vector2d> corners = corridor.corners_m;
  if (!walk.forwards) std::reverse(corners.begin(), corners.end());
  corners.front() += walk.skip_first_m * (corners[1] - corners[0]).normalized();
  const std::size_t last = corners.size() - 1;
  corners[last] -= walk.skip_last_m * (corners[last] - corners[last - 1]).normalized();
  const double speed = random.uniform(0.55, 0.75);
  for (std::size_t i = 0; i < last; ++i) {
    const Vector2d along = (corners[i + 1] - corners[i]).normalized();
    const Vector2d left(-along.y(), along.x());
    const double length = (corners[i + 1] - corners[i]).norm();
    // The robot wanders by some centimetres around the centre line of a corridor.
    for (double s = random.uniform(3.0, 5.0); s < length - 3.0; s += random.uniform(3.5, 6.0)) {
      way.push_back(
          {corners[i] + s * along + random.uniform(-0.07, 0.07) * left, walk.floor_m, speed, "flat"});
    }
    way.push_back({corners[i + 1], walk.floor_m, speed, "flat"});
  }
}

}  // namespace isobar::simulation
