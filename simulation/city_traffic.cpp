// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/city_traffic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/city_furniture.hpp"
#include "simulation/people.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

constexpr double kStepS = SplineGrid::kStepS;
/// Distance beyond which objects may appear and disappear: beyond the lidar's range of 100 m.
constexpr double kSightM = 104.0;
constexpr double kCarMarginM = 16.0;    ///< distance that cars keep from the centre of a crossing
constexpr double kPersonMarginM = 9.0;  ///< the same for people, who stay off the cross streets

/// A street between two crossings, and the time for which the robot can see it.
struct Visit {
  Vector2d from;
  Vector2d along;
  double length_m;
  const Street* street;
  std::size_t first;    ///< first raw sample with the street in sight
  std::size_t nearest;  ///< raw sample with the robot nearest to the middle of the street
  std::size_t count;    ///< number of raw samples with the street in sight

  [[nodiscard]] Vector2d at(double s, double right_m) const {
    return from + s * along + right_m * Vector2d(along.y(), -along.x());
  }
};

Visit find_visit(const CityGrid& grid, const Crossing& a, const Crossing& b,
                 const std::vector<RawPose>& poses) {
  Visit visit{};
  visit.from = grid.at(a);
  visit.length_m = (grid.at(b) - visit.from).norm();
  visit.along = (grid.at(b) - visit.from) / visit.length_m;
  visit.street = &grid.between(a, b);
  const Vector2d middle = visit.at(0.5 * visit.length_m, 0.0);
  const auto distance = [&](std::size_t i) { return (Vector2d(poses[i].x_m, poses[i].y_m) - middle).norm(); };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (distance(i) < distance(visit.nearest)) visit.nearest = i;
  }
  const double sight_m = kSightM + 0.5 * visit.length_m;
  visit.first = visit.nearest;
  while (visit.first > 0 && distance(visit.first - 1) < sight_m) --visit.first;
  std::size_t end = visit.nearest + 1;
  while (end < poses.size() && distance(end) < sight_m) ++end;
  visit.count = end - visit.first;
  return visit;
}

/// A body on the ground; `s`: its distance along the street per sample [m].
MovingBody follow(const Mesh& shape, const Visit& visit, const Terrain& terrain, double right_m,
                  double above_m, const std::vector<double>& s) {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  for (const double at_s : s) {
    const Vector2d at = visit.at(at_s, right_m);
    x.push_back(at.x());
    y.push_back(at.y());
    z.push_back(terrain.height_m(at) + above_m);
  }
  return {RayCaster(shape), Channel(std::move(x)), Channel(std::move(y)), Channel(std::move(z)), visit.first};
}

/// A person who walks to and fro along a pavement.
MovingBody make_pedestrian(const Visit& visit, const Terrain& terrain, Random& random) {
  const double end_m = visit.length_m - kPersonMarginM;
  const double side = random.sign();
  const double right_m =
      side * (visit.street->carriage_m + random.uniform(1.3, std::max(1.4, visit.street->pavement_m - 0.4)));
  double at_m = random.uniform(kPersonMarginM, end_m);
  double velocity = random.sign() * random.uniform(0.9, 1.6);
  std::vector<double> s;
  for (std::size_t i = 0; i < visit.count; ++i) {
    at_m += velocity * kStepS;
    if (at_m < kPersonMarginM || at_m > end_m) velocity = -velocity;
    at_m = std::clamp(at_m, kPersonMarginM, end_m);
    s.push_back(at_m);
  }
  return follow(make_person(random), visit, terrain, right_m, kKerbM, s);
}

/// A car that waits at the far end of the street, drives past the robot and waits again at the near end.
MovingBody make_oncoming_car(const Visit& visit, const Terrain& terrain, Random& random) {
  const double start_m = visit.length_m - kCarMarginM;
  const double way_m = start_m - kCarMarginM;
  const double duration_s = way_m / random.uniform(4.0, 7.0);
  const double middle_s =
      kStepS * static_cast<double>(visit.nearest - visit.first) + random.uniform(-1.5, 1.5);
  std::vector<double> s;
  for (std::size_t i = 0; i < visit.count; ++i) {
    const double phase =
        std::clamp((kStepS * static_cast<double>(i) - middle_s) / duration_s + 0.5, 0.0, 1.0);
    s.push_back(start_m - way_m * phase * phase * (3.0 - 2.0 * phase));
  }
  Mesh shape;
  CityFrame frame;
  frame.along = -visit.along;
  frame.out = Vector2d(visit.along.y(), -visit.along.x());
  frame.rise = terrain.slope(visit.at(0.5 * visit.length_m, 0.0)).dot(frame.along);
  add_car(shape, frame, random);
  return follow(shape, visit, terrain, -CityGrid::kLaneM - 0.1, 0.0, s);
}

}  // namespace

std::vector<MovingBody> make_traffic(const CityGrid& grid, const Terrain& terrain, const CityWay& way,
                                     const std::vector<RawPose>& poses, Random& random) {
  std::vector<MovingBody> bodies;
  for (std::size_t i = 0; i + 1 < way.crossings.size(); ++i) {
    const Crossing& a = way.crossings[i];
    const Crossing& b = way.crossings[i + 1];
    if (times_driven(way, a, b) != 1) continue;
    const Visit visit = find_visit(grid, a, b, poses);
    constexpr std::size_t kMinSamples = 8;  // a quintic spline needs at least six control points
    if (visit.count < kMinSamples) continue;
    const int people = random.integer(1, 4);
    for (int p = 0; p < people; ++p) bodies.push_back(make_pedestrian(visit, terrain, random));
    if (random.chance(0.6)) bodies.push_back(make_oncoming_car(visit, terrain, random));
  }
  return bodies;
}

}  // namespace isobar::simulation
