// SPDX-License-Identifier: BSD-3-Clause
// Scalar Kalman filter of a pressure that stays as it is but for a random walk: the paper's low-pass.
#pragma once

namespace isobar {

/// Constant model. In steady state a first-order low-pass of time constant sqrt(R dt / q): it averages as
/// much as the walk allows, at any sample rate. filter_design.hpp finds the walk for a wanted lag.
class PressureFilter {
 public:
  /// `walk_pa_sqrt_s`: random walk of the true pressure [Pa/sqrt(s)], > 0.
  explicit PressureFilter(double walk_pa_sqrt_s) : walk_variance_pa2_s_(walk_pa_sqrt_s * walk_pa_sqrt_s) {}

  /// Takes a sample `dt_s` (>= 0) after the one before, with white noise of `noise_variance_pa2` (> 0).
  void add(double pressure_pa, double dt_s, double noise_variance_pa2) {
    if (!started_) {
      pressure_pa_ = pressure_pa;
      variance_pa2_ = noise_variance_pa2;
      delay_s_ = 0.0;
      started_ = true;
      return;
    }
    variance_pa2_ += walk_variance_pa2_s_ * dt_s;
    const double gain = variance_pa2_ / (variance_pa2_ + noise_variance_pa2);
    pressure_pa_ += gain * (pressure_pa - pressure_pa_);
    variance_pa2_ *= 1.0 - gain;
    delay_s_ = (1.0 - gain) * (delay_s_ + dt_s);
  }

  void restart() { started_ = false; }
  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] double pressure_pa() const { return pressure_pa_; }
  /// Variance of pressure_pa() at the last sample; `age_s` later it is larger by the walk.
  [[nodiscard]] double variance_pa2(double age_s = 0.0) const {
    return variance_pa2_ + walk_variance_pa2_s_ * age_s;
  }
  /// How long before the last sample pressure_pa() was true, if the pressure changes at a constant rate: the
  /// output is a weighted mean of the samples, and this is the mean of their ages, with the same weights [s].
  /// Exact from the first sample on and at any spacing; in steady state dt (1 - K) / K.
  [[nodiscard]] double delay_s() const { return delay_s_; }

 private:
  double walk_variance_pa2_s_;
  double pressure_pa_ = 0.0;
  double variance_pa2_ = 0.0;
  double delay_s_ = 0.0;
  bool started_ = false;
};

}  // namespace isobar
