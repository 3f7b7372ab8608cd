// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/level_surfaces.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <bitset>
#include <cmath>

#include "core/geometry.hpp"
#include "core/mounts/level_plane.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Capacity [points]: ten scans thinned for the map, or one complete one of 16 beams.
constexpr std::size_t kMostPoints = 30'000;
// Error of gravity by the bias of the accelerometer, 1 sigma: 5 mg.
constexpr double kAccelBiasTiltRad = 0.29 * kRadPerDeg;
// Two kinds of surfaces agree below this chi-square of 2 degrees of freedom, at 90 %: a ramp of 1 deg between plumb
// walls does not.
constexpr double kAgreement = 4.6;
// Floors and ceilings are level to 0.2 deg, 1 sigma, where walls verify it to 0.6 deg; elsewhere they slope by degrees.
constexpr double kLevelFloorRad2 = squared(0.2 * kRadPerDeg);
constexpr double kVerifiedRad2 = squared(0.6 * kRadPerDeg);
constexpr double kAnyFloorRad2 = squared(2.0 * kRadPerDeg);
// Variance of a direction about which surfaces say something [rad^2].
constexpr double kToldRad2 = squared(0.7 * kRadPerDeg);

// Steps of 1 deg at the horizon, growing to 17 deg: a floor seen from 4 m on has four of them, a ceiling above as well, and
// one laser by a mount that is off by 1 deg has three.
std::uint8_t elevation_step(float elevation_rad) {
  constexpr float kLinearRad = static_cast<float>(3.0 * kRadPerDeg);
  constexpr float kSteps = 3.0F;
  constexpr float kHorizon = 128.0F;
  return static_cast<std::uint8_t>(kHorizon + std::round(kSteps * std::asinh(elevation_rad / kLinearRad)));
}

bool agree(const TiltEvidence& a, const TiltEvidence& b) {
  const Eigen::Vector2d difference = a.tilt_rad - b.tilt_rad;
  const Eigen::Matrix2d covariance = a.covariance_rad2 + b.covariance_rad2;
  return difference.dot(covariance.inverse() * difference) < kAgreement;
}

TiltEvidence joined(const TiltEvidence& a, const TiltEvidence& b) {
  const Eigen::Matrix2d information_a = a.covariance_rad2.inverse();
  const Eigen::Matrix2d information_b = b.covariance_rad2.inverse();
  TiltEvidence out;
  out.covariance_rad2 = (information_a + information_b).inverse();
  out.tilt_rad = out.covariance_rad2 * (information_a * a.tilt_rad + information_b * b.tilt_rad);
  return out;
}

// A floor is level where walls could have shown that it is not: a street between houses slopes along them.
Eigen::Matrix2d levelness_rad2(const TiltEvidence& walls) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(walls.covariance_rad2);
  const Eigen::Vector2d variances = eigen.eigenvalues().unaryExpr(
      [](double variance) { return variance < kVerifiedRad2 ? kLevelFloorRad2 : kAnyFloorRad2; });
  return eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
}

// Walls of at least one direction, and a floor or ceiling that agrees with them; the second one is used if it agrees.
std::optional<TiltEvidence> building(const TiltEvidence& walls, const LevelPlanes& planes) {
  const Eigen::Matrix2d levelness = levelness_rad2(walls);
  TiltEvidence sum = walls;
  bool agreed = false;
  for (const auto& plane : planes) {
    if (!plane) continue;
    TiltEvidence tilt = plane->tilt;
    tilt.covariance_rad2 += levelness;
    if (agree(sum, tilt)) {
      sum = joined(sum, tilt);
      agreed = true;
    } else if (!agreed) {
      return std::nullopt;
    }
  }
  if (!agreed) return std::nullopt;
  return sum;
}

}  // namespace

LevelSurfaces::LevelSurfaces(const Eigen::Vector3d& p_base_lidar_m)
    : p_base_lidar_m_(p_base_lidar_m.cast<float>()) {
  p_base_.reserve(kMostPoints);
  p_level_.reserve(kMostPoints);
}

void LevelSurfaces::add(std::span<const ScanPoint> p_base) {
  for (const ScanPoint& p : p_base) {
    if (full()) return;
    p_base_.push_back({{p.x_m, p.y_m, p.z_m}, p.ring});
  }
}

// A lidar without lasers one above the other (non-repetitive scans) has one ring or few: steps of elevation stand in for them.
void LevelSurfaces::tell_rings_by_elevation() {
  std::bitset<256> rings;
  for (const LevelPoint& point : p_base_) rings.set(point.ring);
  if (rings.count() >= static_cast<std::size_t>(kLeastLevelRings)) return;
  for (LevelPoint& point : p_base_) {
    const Eigen::Vector3f ray_m = point.p_m - p_base_lidar_m_;
    point.ring = elevation_step(std::atan2(ray_m.z(), ray_m.head<2>().norm()));
  }
}

std::optional<LevelEvidence> LevelSurfaces::find(const Eigen::Vector3d& up_by_gravity,
                                                 double gravity_variance_rad2) {
  tell_rings_by_elevation();
  const auto q_level_base = Eigen::Quaterniond::FromTwoVectors(up_by_gravity, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d R_level_base = q_level_base.toRotationMatrix();
  const Eigen::Matrix3f rotation = R_level_base.cast<float>();
  const auto level_points = [&] {
    p_level_.clear();
    for (const LevelPoint& point : p_base_) p_level_.push_back({rotation * point.p_m, point.ring});
  };
  // Floor and walls meet: each is found best without the points of the other.
  level_points();
  remove_planes(level_planes(p_level_), p_level_);
  const auto walls = walls_.find(p_level_);
  if (!walls) return std::nullopt;
  level_points();
  walls_.remove_walls(p_level_);
  const auto tilt = building(*walls, level_planes(p_level_));
  if (!tilt || tilt->covariance_rad2.diagonal().minCoeff() > kToldRad2) return std::nullopt;

  LevelEvidence out;
  out.up_by_gravity = up_by_gravity;
  const Eigen::Vector3d up_level(tilt->tilt_rad.x(), tilt->tilt_rad.y(), 1.0);
  out.up_by_surfaces = (R_level_base.transpose() * up_level).normalized();
  Eigen::Matrix3d surfaces = Eigen::Matrix3d::Zero();
  surfaces.topLeftCorner<2, 2>() = tilt->covariance_rad2;
  out.surfaces_covariance_rad2 = R_level_base.transpose() * surfaces * R_level_base;
  out.covariance_rad2 = out.surfaces_covariance_rad2 +
                        (squared(kAccelBiasTiltRad) + gravity_variance_rad2) * Eigen::Matrix3d::Identity();
  return out;
}

}  // namespace isobar
