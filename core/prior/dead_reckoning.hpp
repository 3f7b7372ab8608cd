// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry: distance rolled, as a function of time.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/prior/prior_config.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Use of a wheel sample.
enum class WheelStatus : std::uint8_t { kAccepted, kBadValue, kBadTime };

/// Integrates wheel speeds (trapezoids). Between samples the distance is extrapolated; the next sample
/// corrects the error of the extrapolation, so that late samples lose no distance.
class WheelOdometer {
 public:
  explicit WheelOdometer(const DeadReckoningConfig& config) : config_(config) {}

  void configure(const DeadReckoningConfig& config) { config_ = config; }

  WheelStatus add(const WheelSample& sample);

  /// Displacement in base_link since the last call, up to `stamp_ns` [m]; zero where the wheels are not
  /// valid.
  Eigen::Vector2d take_displacement(std::int64_t stamp_ns);

  /// Turn about z since the start [rad]; a gap counts as zero.
  [[nodiscard]] double turn_rad(std::int64_t stamp_ns) const;

  /// Wheels are present and fresh at `stamp_ns`.
  [[nodiscard]] bool valid(std::int64_t stamp_ns) const;
  /// The last accepted sample. Precondition: valid().
  [[nodiscard]] const WheelSample& last() const { return last_; }
  /// Time between the last two samples [s].
  [[nodiscard]] double interval_s() const { return interval_s_; }

 private:
  [[nodiscard]] bool plausible(const WheelSample& sample, double dt_s);

  DeadReckoningConfig config_;
  WheelSample last_;
  Eigen::Vector2d rolled_m_ = Eigen::Vector2d::Zero();  // up to last_
  Eigen::Vector2d taken_m_ = Eigen::Vector2d::Zero();   // by take_displacement()
  double turned_rad_ = 0.0;                             // up to last_
  double interval_s_ = 0.0;
  int refused_in_a_row_ = 0;
  bool started_ = false;
};

}  // namespace isobar
