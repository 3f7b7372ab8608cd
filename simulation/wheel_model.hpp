// SPDX-License-Identifier: BSD-3-Clause
// Model of wheel odometry: the twist that a base computes from the speeds of its tracks or wheels and their
// nominal geometry.
#pragma once

#include "core/samples.hpp"
#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// Errors of one robot's odometry. The defaults are zero, for tests.
struct WheelErrors {
  double scale = 0.0;            ///< constant relative error of the speed: tread wear and tension
  double turn_scale = 0.0;       ///< constant relative error of the turn rate: effective track width
  double slip_sigma = 0.0;       ///< relative slip of the speed, rms, tau 1 s
  double stair_slip = 0.0;       ///< relative slip of the speed on stairs
  double turn_slip_sigma = 0.0;  ///< relative slip of the turn rate, rms, tau 1 s
  double noise_m_s = 0.0;        ///< white noise per sample
  double noise_rad_s = 0.0;      ///< white noise per sample

  /// Random errors of tracks, or of a steered vehicle on tyres; sources in wheel_model.cpp.
  [[nodiscard]] static WheelErrors draw(Random random, bool tracked = true);
};

/// Odometry of one robot. Samples must be taken in time order.
class WheelModel {
 public:
  static constexpr double kRateHz = 50.0;

  WheelModel(const Trajectory& trajectory, const WheelErrors& errors, Random random);
  /// Sample at `time_s`. The caller sets stamp_ns.
  [[nodiscard]] WheelSample sample(double time_s);

 private:
  const Trajectory& trajectory_;
  WheelErrors errors_;
  Random random_;
  GaussMarkov slip_;
  GaussMarkov turn_slip_;
};

}  // namespace isobar::simulation
