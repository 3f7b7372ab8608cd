// SPDX-License-Identifier: BSD-3-Clause
#include "simulated_place.hpp"

#include <array>
#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"

namespace isobar {

namespace {

constexpr int kLasers = 16;
constexpr int kAzimuths = 1800;
constexpr double kReachM = 80.0;
constexpr float kLeastCosine = 0.05F;
constexpr double kScanS = 0.1;

Eigen::Vector3d random_tilt(simulation::Random& random, double sigma_deg) {
  return Eigen::Vector3d(random.normal(sigma_deg), random.normal(sigma_deg), 0.0) * kRadPerDeg;
}

/// The lidar that fires.
struct Lidar {
  std::array<double, kLasers> bias_m{};
  Eigen::Isometry3d T_world_lidar;
  double phase_rad = 0.0;
};

Eigen::Vector3d ray_of(double yaw, int laser) {
  const double pitch = (2.0 * laser - 15.0) * kRadPerDeg;
  return {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
}

// p_lidar of one revolution.
void revolve(const simulation::World& world, double time_s, const Lidar& lidar, simulation::Random& random,
             std::vector<Eigen::Vector3f>& points) {
  simulation::World::Moment moment;
  const Eigen::Vector3d eye = lidar.T_world_lidar.translation();
  world.look(time_s, eye, kReachM, moment);
  for (int azimuth = 0; azimuth < kAzimuths; ++azimuth) {
    for (int laser = 0; laser < kLasers; ++laser) {
      const Eigen::Vector3d ray = ray_of(lidar.phase_rad + 2.0 * kPi * azimuth / kAzimuths, laser);
      const simulation::Hit hit = world.cast(moment, eye, lidar.T_world_lidar.linear() * ray, kReachM);
      if (!hit.found || hit.cos_incidence < kLeastCosine || hit.distance_m < 0.5F) continue;
      const double range_m = static_cast<double>(hit.distance_m) + random.normal(0.015) +
                             lidar.bias_m.at(static_cast<std::size_t>(laser));
      points.emplace_back((ray * range_m).cast<float>());
    }
  }
}

}  // namespace

LevelledScans scans_at(const simulation::Scenario& scenario, const SimulatedPlace& place,
                       simulation::Random& random) {
  LevelledScans out;
  const Eigen::Matrix3d& R_world_base = place.T_world_base.linear();
  const Eigen::Matrix3d R_level_world = rotation_about_z(-std::atan2(R_world_base(1, 0), R_world_base(0, 0)));
  const Eigen::Matrix3d error = exp_so3(random_tilt(random, 0.2)).toRotationMatrix();
  out.R_level_base = error * R_level_world * R_world_base;
  const Eigen::Isometry3d T_base_lidar = scenario.mounts.lidar.T_base_sensor();
  Lidar lidar;
  for (double& bias_m : lidar.bias_m) bias_m = random.normal(0.01);
  lidar.T_world_lidar = place.T_world_base * T_base_lidar;
  lidar.T_world_lidar.linear() *= exp_so3(random_tilt(random, 0.05)).toRotationMatrix();
  out.p_level_lidar = (out.R_level_base * T_base_lidar.translation()).cast<float>();
  const Eigen::Matrix3f R_level_lidar = (out.R_level_base * T_base_lidar.linear()).cast<float>();
  for (int scan = 0; scan < place.scans; ++scan) {
    lidar.phase_rad = random.uniform(0.0, 2.0 * kPi);
    std::vector<Eigen::Vector3f>& points = out.p_level.emplace_back();
    revolve(scenario.world, place.time_s + scan * kScanS, lidar, random, points);
    for (Eigen::Vector3f& p : points) p = out.p_level_lidar + R_level_lidar * p;
  }
  return out;
}

double different_share(const simulation::Scenario& scenario, const Eigen::Isometry3d& T_world_one,
                       const Eigen::Isometry3d& T_world_other) {
  constexpr int kRays = 360;
  constexpr float kDifferentM = 0.1F;
  const Eigen::Isometry3d T_base_lidar = scenario.mounts.lidar.T_base_sensor();
  const simulation::RayCaster& world = scenario.world.standing();
  const auto range_m = [&](const Eigen::Isometry3d& T_world_base, const Eigen::Vector3d& ray) {
    const Eigen::Isometry3d T_world_lidar = T_world_base * T_base_lidar;
    return world
        .cast(T_world_lidar.translation().cast<float>(), (T_world_lidar.linear() * ray).cast<float>(),
              static_cast<float>(kReachM))
        .distance_m;
  };
  int different = 0;
  for (int azimuth = 0; azimuth < kRays; ++azimuth) {
    for (int laser = 0; laser < kLasers; ++laser) {
      const Eigen::Vector3d ray = ray_of(2.0 * kPi * azimuth / kRays, laser);
      different += std::abs(range_m(T_world_one, ray) - range_m(T_world_other, ray)) > kDifferentM ? 1 : 0;
    }
  }
  return double(different) / (kRays * kLasers);
}

}  // namespace isobar
