// SPDX-License-Identifier: BSD-3-Clause
// Registration and map in lock step, driven through a synthetic world.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>

#include "core/map/local_map.hpp"
#include "core/registration/registration.hpp"
#include "tests/core/registration/synthetic_world.hpp"

namespace isobar::test {

/// Start of a run, and the duration of a scan.
inline constexpr std::int64_t kRunStartNs = 1'700'000'000'000'000'000;
inline constexpr std::int64_t kRunScanNs = 100'000'000;

/// Pose of the lidar of a run in base_link.
Eigen::Isometry3d run_lidar_mount();

/// A circle of 1.5 m radius in the middle of the room at 0.6 m/s, from yaw 0, after a second of standing;
/// with the small rocking of a tracked robot.
Eigen::Isometry3d circle(std::int64_t stamp_ns);
/// Along x at 0.8 m/s after a second of standing.
Eigen::Isometry3d along_x(std::int64_t stamp_ns);

using MakePrior = std::function<Prior(std::int64_t stamp_ns)>;

/// Dead reckoning with 4 % of scale error and 0.3 degrees of yaw drift a second; heights relative to the
/// start.
MakePrior drifting(const Motion& motion);
/// The same priors without wheels: no translation, no velocity.
MakePrior without_wheels(const MakePrior& make);

/// A registration and its map. Scans have 1.5 cm of noise.
class RegistrationRun {
 public:
  RegistrationRun(World world, Motion motion, MakePrior make_prior, Method method);

  /// Adds the priors up to the end of the next scan; registers and maps the scan unless it is lost.
  const PoseEstimate& step(bool scan_arrives = true);
  void steps(int count);
  /// Registers and maps scan() as it is.
  const PoseEstimate& register_scan();

  /// Error of the newest position [m], in the frame given by position and yaw of the first pose.
  [[nodiscard]] Eigen::Vector3d position_error() const;
  [[nodiscard]] double rotation_error_deg() const;

  [[nodiscard]] const PoseEstimate& pose() const { return out_->pose; }
  Registration& registration() { return *registration_; }
  /// Builds the registration anew with other settings, as a live run does when its configuration changes.
  void rebuild(const RegistrationConfig& config, Method method);
  LocalMap& map() { return *map_; }
  /// A new map frame; the sensors' clocks start over at the start of the run.
  void start_over() {
    registration_->begin_new_frame();
    map_ = std::make_unique<LocalMap>(MapConfig{}, run_lidar_mount(), nullptr, registration_->session());
    index_ = 0;
  }
  /// Another map, laid from the same scans, takes the place of this one.
  void exchange_map(std::unique_ptr<LocalMap> map) { map_ = std::move(map); }
  [[nodiscard]] const RegisteredScan& registered_scan() const { return *out_; }
  /// A new registration continues at `place` with the same map.
  void restart_at(const KnownPlace& place);
  Scan& scan() { return *scan_; }
  /// Replaces the world from the next scan on.
  void enter(const World& world) { world_ = world; }
  /// Calls of operator new by all registrations so far.
  [[nodiscard]] std::size_t allocations() const { return allocations_; }

 private:
  World world_;
  Motion motion_;
  MakePrior make_prior_;
  Method method_;
  std::unique_ptr<Registration> registration_;
  std::unique_ptr<LocalMap> map_;
  std::mt19937 random_{42};
  std::int64_t index_ = 0;
  std::unique_ptr<Scan> scan_ = std::make_unique<Scan>();
  std::unique_ptr<RegisteredScan> out_ = std::make_unique<RegisteredScan>();
  std::size_t allocations_ = 0;
};

}  // namespace isobar::test
