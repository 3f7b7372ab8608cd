// SPDX-License-Identifier: BSD-3-Clause
// Odometry of a robot: speeds of tracks or wheels turned into a twist by somebody's nominal geometry.
#pragma once

#include "core/samples.hpp"
#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// Errors of one robot's odometry. Defaults are none, for tests.
struct WheelErrors {
  double scale = 0.0;            ///< of distance, fixed: tread wear and tension
  double turn_scale = 0.0;       ///< of turn rate, fixed: the effective track width is not the nominal one
  double slip_sigma = 0.0;       ///< of distance, varying over a second
  double stair_slip = 0.0;       ///< share of track motion lost on steps: measured = true / (1 - slip)
  double turn_slip_sigma = 0.0;  ///< of turn rate, varying
  double noise_m_s = 0.0;
  double noise_rad_s = 0.0;

  /// Of tracks, or of a vehicle that steers and rolls on tyres.
  [[nodiscard]] static WheelErrors draw(Random random, bool tracked = true);
};

/// Samples must be taken in time order.
class WheelModel {
 public:
  static constexpr double kRateHz = 50.0;

  WheelModel(const Trajectory& trajectory, const WheelErrors& errors, Random random);
  [[nodiscard]] WheelSample sample(double time_s);

 private:
  const Trajectory& trajectory_;
  WheelErrors errors_;
  Random random_;
  GaussMarkov slip_;
  GaussMarkov turn_slip_;
};

}  // namespace isobar::simulation
