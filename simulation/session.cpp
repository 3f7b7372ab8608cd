// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/session.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/random.hpp"

namespace isobar::simulation {

namespace {

// Way between two pieces of furniture, their distance from it, and the least distance from every part of it.
constexpr double kLeastApartM = 4.0;
constexpr double kMostApartM = 12.0;
constexpr double kBesideM = 0.75;
constexpr double kClearM = 0.6;

MovingBody standing_body(const Mesh& mesh, const Eigen::Vector3d& p, std::size_t samples) {
  return {RayCaster(mesh), Channel(std::vector<double>(samples, p.x())),
          Channel(std::vector<double>(samples, p.y())), Channel(std::vector<double>(samples, p.z()))};
}

Mesh make_furniture(Random& random) {
  Mesh mesh;
  const double half_x_m = random.uniform(0.15, 0.3);
  const double half_y_m = random.uniform(0.15, 0.3);
  mesh.box({-half_x_m, -half_y_m, 0.0}, {half_x_m, half_y_m, random.uniform(0.5, 1.8)}, Surface::kCloth);
  return mesh;
}

/// True where the robot drives past without touching it.
bool is_clear(const std::vector<RawPose>& way, const Eigen::Vector3d& p) {
  return std::all_of(way.begin(), way.end(), [&](const RawPose& at) {
    return std::abs(at.z_m - p.z()) > 2.0 || std::hypot(at.x_m - p.x(), at.y_m - p.y()) > kClearM;
  });
}

}  // namespace

void begin_another_session(Scenario& scenario, std::uint64_t session_seed) {
  Random random(session_seed, "session");
  scenario.air_temperature_c += random.normal(1.5);
  scenario.start_pressure_pa += random.normal(900.0);
  std::vector<MovingBody> furniture;
  const std::vector<RawPose>& way = scenario.raw;
  double next_m = random.uniform(kLeastApartM, kMostApartM);
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Eigen::Vector2d step(way[i].x_m - way[i - 1].x_m, way[i].y_m - way[i - 1].y_m);
    next_m -= step.norm();
    if (next_m > 0.0 || step.norm() == 0.0 || std::abs(way[i].z_m - way[i - 1].z_m) > 1e-4) continue;
    next_m = random.uniform(kLeastApartM, kMostApartM);
    const Eigen::Vector2d left = Eigen::Vector2d(-step.y(), step.x()).normalized() * random.sign() * kBesideM;
    const Eigen::Vector3d p(way[i].x_m + left.x(), way[i].y_m + left.y(), way[i].z_m);
    if (is_clear(way, p)) furniture.push_back(standing_body(make_furniture(random), p, way.size()));
  }
  scenario.world.add(std::move(furniture));
}

}  // namespace isobar::simulation
