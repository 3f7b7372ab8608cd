// SPDX-License-Identifier: BSD-3-Clause
// Scalar Kalman filter of a random-walk pressure: the paper's low-pass.
#pragma once

#include <algorithm>
#include <limits>

#include "core/squared.hpp"

namespace isobar {

/// Random-walk model. In steady state a first-order low-pass with time constant sqrt(R dt / q): as much
/// averaging as the walk allows, at any sample rate. core/calibration/filter_design.hpp gives the walk for a
/// wanted lag.
class PressureFilter {
 public:
  /// `walk_pa_sqrt_s`: random walk of the true pressure [Pa/sqrt(s)], > 0. `longest_lag_s`: upper bound of the time
  /// constant in steady state [s], by a larger walk where samples are few or noisy.
  explicit PressureFilter(double walk_pa_sqrt_s,
                          double longest_lag_s = std::numeric_limits<double>::infinity())
      : walk_variance_pa2_s_(squared(walk_pa_sqrt_s)), longest_lag_s_(longest_lag_s) {}

  /// Updates with a sample `dt_s` (>= 0) after the previous one, of white noise `noise_variance_pa2` (> 0).
  void add(double pressure_pa, double dt_s, double noise_variance_pa2) {
    if (!started_) {
      pressure_pa_ = pressure_pa;
      variance_pa2_ = noise_variance_pa2;
      delay_s_ = 0.0;
      started_ = true;
      return;
    }
    // Time constant sqrt(R dt / q): q >= R dt / lag^2 bounds it.
    variance_pa2_ +=
        std::max(walk_variance_pa2_s_, noise_variance_pa2 * dt_s / squared(longest_lag_s_)) * dt_s;
    const double gain = variance_pa2_ / (variance_pa2_ + noise_variance_pa2);
    pressure_pa_ += gain * (pressure_pa - pressure_pa_);
    variance_pa2_ *= 1.0 - gain;
    delay_s_ = (1.0 - gain) * (delay_s_ + dt_s);
  }

  void restart() { started_ = false; }
  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] double pressure_pa() const { return pressure_pa_; }
  /// Variance of pressure_pa() at the last sample.
  [[nodiscard]] double variance_pa2() const { return variance_pa2_; }
  /// Group delay at 0 Hz [s]: lag of pressure_pa() behind a pressure that changes at a constant rate. The
  /// output is a weighted mean of the samples; the delay is the mean of their ages with the same weights.
  /// Exact from the first sample on, at any spacing; in steady state dt (1 - K) / K.
  [[nodiscard]] double delay_s() const { return delay_s_; }

 private:
  double walk_variance_pa2_s_;
  double longest_lag_s_;
  double pressure_pa_ = 0.0;
  double variance_pa2_ = 0.0;
  double delay_s_ = 0.0;
  bool started_ = false;
};

}  // namespace isobar
