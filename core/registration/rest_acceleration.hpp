// SPDX-License-Identifier: BSD-3-Clause
// Vertical acceleration that the accelerometer shows at rest: its bias, and what its tilt takes from gravity.
//
//     db/dt = random walk,  mean acceleration of a rest = b + noise
//
// A scalar Kalman filter over every rest of a run: a ride that begins without one is not without a bias.
#pragma once

#include "core/squared.hpp"

namespace isobar {

/// Bias of the vertical acceleration. Allocates nothing.
class RestAcceleration {
 public:
  /// Bias without any rest, 1 sigma [m/s^2]: 5 mg.
  static constexpr double kUnknownMS2 = 0.05;
  /// Random walk of the bias [m/s^2/sqrt(s)]: warm-up.
  static constexpr double kWalkMS2SqrtS = 2e-4;
  /// Noise of a rest besides the accelerometer's: people who step in, doors [m/s^2 sqrt(s)].
  static constexpr double kDisturbedSqrtS = 0.003;

  /// Time without a rest.
  void advance(double dt_s) { variance_ += squared(kWalkMS2SqrtS) * dt_s; }

  /// A rest of `dt_s` whose acceleration is `mean_m_s2` on average, with noise of `density` [m^2/s^3].
  void add(double mean_m_s2, double dt_s, double density) {
    advance(dt_s);
    const double noise = (squared(kDisturbedSqrtS) + density) / dt_s;
    const double gain = variance_ / (variance_ + noise);
    mean_ += gain * (mean_m_s2 - mean_);
    variance_ *= 1.0 - gain;
  }

  [[nodiscard]] double mean_m_s2() const { return mean_; }
  [[nodiscard]] double variance() const { return variance_; }
  /// Some rest has been seen.
  [[nodiscard]] bool known() const { return variance_ < squared(0.5 * kUnknownMS2); }

 private:
  double mean_ = 0.0;
  double variance_ = squared(kUnknownMS2);
};

}  // namespace isobar
