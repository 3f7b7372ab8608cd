// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.hpp"

#include <algorithm>
#include <utility>

namespace isobar::simulation {

using Eigen::Vector3d;
using Eigen::Vector3f;

World::World(const Mesh& standing, std::vector<MovingBody> moving)
    : standing_(standing), moving_(std::move(moving)) {
  for (const MovingBody& body : moving_) samples_ = std::max(samples_, body.first + body.x_m.size());
}

void World::add(std::vector<MovingBody> moving) {
  for (MovingBody& body : moving) {
    samples_ = std::max(samples_, body.first + body.x_m.size());
    moving_.push_back(std::move(body));
  }
}

void World::look(double time_s, const Vector3d& eye, double range_m, Moment& moment) const {
  moment.bodies.clear();
  if (moving_.empty()) return;
  const SplineWeights now = SplineGrid::weights(time_s, samples_);
  for (const MovingBody& body : moving_) {
    if (now.first < body.first || now.first + now.value.size() > body.first + body.x_m.size()) continue;
    SplineWeights weights = now;
    weights.first -= body.first;
    const Vector3d origin(body.x_m.value(weights), body.y_m.value(weights), body.z_m.value(weights));
    const Vector3f half = 0.5F * (body.shape.high() - body.shape.low());
    const Vector3f centre = origin.cast<float>() + body.shape.low() + half;
    if ((centre - eye.cast<float>()).norm() > static_cast<float>(range_m) + half.norm()) continue;
    moment.bodies.push_back({origin, centre, half.norm(), &body.shape});
  }
}

Hit World::cast(const Moment& moment, const Vector3d& origin, const Vector3d& direction,
                double limit_m) const {
  const Vector3f eye = origin.cast<float>();
  const Vector3f ray = direction.cast<float>();
  Hit best = standing_.cast(eye, ray, static_cast<float>(limit_m));
  for (const Moment::Body& body : moment.bodies) {
    const Vector3f way = body.centre - eye;
    const float along = way.dot(ray);
    if (along < -body.radius_m || along - body.radius_m > best.distance_m) continue;
    if ((way - along * ray).squaredNorm() > body.radius_m * body.radius_m) continue;
    const Hit hit = body.shape->cast((origin - body.origin).cast<float>(), ray, best.distance_m);
    if (hit.found) best = hit;
  }
  return best;
}

}  // namespace isobar::simulation
