// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/registration/registration_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test {

namespace {

constexpr double kNoiseM = 0.015;
constexpr double kSensorHeightM = 0.7;

// Seconds of driving: the robot stands for the first second.
double driving_s(std::int64_t stamp_ns) {
  return std::max(0.0, seconds_between(kRunStartNs, stamp_ns) - 1.0);
}

}  // namespace

Eigen::Isometry3d run_lidar_mount() { return Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.3)); }

Eigen::Isometry3d circle(std::int64_t stamp_ns) {
  const double t = driving_s(stamp_ns);
  const double angle = 0.4 * t;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      rotation_from_rpy({0.02 * std::sin(3.1 * t), 0.02 * std::sin(2.0 * t), angle}).toRotationMatrix();
  T.translation() << 1.5 * std::sin(angle), -1.5 * std::cos(angle), kSensorHeightM;
  return T;
}

Eigen::Isometry3d along_x(std::int64_t stamp_ns) {
  return Eigen::Isometry3d(Eigen::Translation3d(0.8 * driving_s(stamp_ns), 0.0, kSensorHeightM));
}

MakePrior drifting(const Motion& motion) {
  return [motion](std::int64_t stamp_ns) {
    Prior prior = perfect_prior(motion, stamp_ns);
    const double drift = 0.005 * seconds_between(kRunStartNs, stamp_ns);
    prior.T_odom_base.linear() = rotation_about_z(drift) * prior.T_odom_base.linear();
    prior.T_odom_base.translation().head<2>() *= 1.04;
    prior.height_m -= kSensorHeightM;
    return prior;
  };
}

MakePrior without_wheels(const MakePrior& make) {
  return [make](std::int64_t stamp_ns) {
    Prior prior = make(stamp_ns);
    prior.T_odom_base.translation().setZero();
    prior.velocity_valid = false;
    return prior;
  };
}

RegistrationRun::RegistrationRun(World world, Motion motion, MakePrior make_prior, Method method)
    : world_(std::move(world)),
      motion_(std::move(motion)),
      make_prior_(std::move(make_prior)),
      method_(method),
      registration_(std::make_unique<Registration>(RegistrationConfig{}, method, run_lidar_mount())),
      map_(std::make_unique<LocalMap>(MapConfig{}, run_lidar_mount())) {
  registration_->add_prior(make_prior_(kRunStartNs));
}

void RegistrationRun::rebuild(const RegistrationConfig& config, Method method) {
  auto next = std::make_unique<Registration>(config, method, run_lidar_mount());
  next->take_over(*registration_);
  registration_ = std::move(next);
}

const PoseEstimate& RegistrationRun::step(bool scan_arrives) {
  constexpr std::int64_t kPriorNs = 5'000'000;
  const std::int64_t begin = kRunStartNs + index_++ * kRunScanNs;
  for (std::int64_t t = begin + kPriorNs; t <= begin + kRunScanNs + kPriorNs; t += kPriorNs) {
    registration_->add_prior(make_prior_(t));
  }
  if (scan_arrives) {
    scan_world(world_, motion_, run_lidar_mount(), begin, kNoiseM, random_, *scan_);
    register_scan();
  }
  return out_->pose;
}

void RegistrationRun::restart_at(const KnownPlace& place) {
  registration_ = std::make_unique<Registration>(RegistrationConfig{}, method_, run_lidar_mount());
  registration_->resume(place);
}

void RegistrationRun::steps(int count) {
  for (int i = 0; i < count; ++i) {
    step();
  }
}

const PoseEstimate& RegistrationRun::register_scan() {
  const std::size_t before = allocation_count();
  registration_->register_scan(*scan_, *map_->snapshot(), *out_);
  allocations_ += allocation_count() - before;
  map_->update(*out_);
  return out_->pose;
}

Eigen::Vector3d RegistrationRun::position_error() const {
  const Eigen::Vector3d p_world = motion_(kRunStartNs).translation() + out_->pose.T_map_base.translation();
  return p_world - motion_(out_->pose.stamp_ns).translation();
}

double RegistrationRun::rotation_error_deg() const {
  const Eigen::Matrix3d error =
      out_->pose.T_map_base.linear() * motion_(out_->pose.stamp_ns).linear().transpose();
  return rotation_angle_rad(Eigen::Quaterniond(error)) / kRadPerDeg;
}

}  // namespace isobar::test
