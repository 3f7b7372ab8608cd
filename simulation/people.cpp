// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people.hpp"

#include <algorithm>
#include <utility>

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Distance that people keep from the corners, where the robot turns.
double margin_m(const Corridor& corridor) { return 0.5 * corridor.width_m + 1.0; }

double span_m(const Corridor& corridor, std::size_t leg) {
  return (corridor.corners_m[leg + 1] - corridor.corners_m[leg]).norm() - 2.0 * margin_m(corridor);
}

}  // namespace

bool can_walk(const Corridor& corridor, std::size_t leg) { return span_m(corridor, leg) > 1.0; }

Mesh make_person(Random& random) {
  const double height = random.uniform(1.55, 1.90);
  Mesh body;
  body.prism({-0.07, 0.10, 0.0}, 0.08, 0.48 * height, 6, Surface::kCloth);
  body.prism({0.07, -0.10, 0.0}, 0.08, 0.48 * height, 6, Surface::kCloth);
  body.prism({0.0, 0.0, 0.48 * height}, 0.20, 0.36 * height, 8, Surface::kCloth);
  body.prism({0.0, 0.0, 0.85 * height}, 0.10, 0.15 * height, 8, Surface::kCloth);
  return body;
}

MovingBody make_walker(const Corridor& corridor, std::size_t leg, double floor_z_m, std::size_t samples,
                       Random& random) {
  const Mesh body = make_person(random);
  const Vector2d from = corridor.corners_m[leg];
  const Vector2d way = corridor.corners_m[leg + 1] - from;
  const Vector2d along = way.normalized();
  const Vector2d left(-along.y(), along.x());
  const double margin = margin_m(corridor);
  const double span = span_m(corridor, leg);
  const double lateral = random.sign() * (0.5 * corridor.width_m - 0.30);
  double s = random.uniform(0.0, span);
  double direction = random.sign();
  double speed = random.uniform(0.9, 1.4);
  double pause_s = 0.0;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < samples; ++i) {
    if (pause_s > 0.0) {
      pause_s -= SplineGrid::kStepS;
    } else {
      s += direction * speed * SplineGrid::kStepS;
      if (s <= 0.0 || s >= span) {
        s = std::clamp(s, 0.0, span);
        direction = -direction;
        speed = random.uniform(0.9, 1.4);
        pause_s = random.exponential(6.0);
      }
    }
    const Vector2d at = from + (margin + s) * along + lateral * left;
    x.push_back(at.x());
    y.push_back(at.y());
  }
  return {RayCaster(body), Channel(std::move(x)), Channel(std::move(y)),
          Channel(std::vector<double>(samples, floor_z_m))};
}

}  // namespace isobar::simulation
