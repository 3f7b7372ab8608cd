// SPDX-License-Identifier: BSD-3-Clause
// Learnt error of the barometric height by the robot's own wind.
#pragma once

#include <Eigen/Core>

namespace isobar {

/// Kalman filter of the coefficient k with which the air that flows past the pressure port raises the barometric
/// height, in still air:
///
///   altimeter - height = b + k v^2 + noise,   k = C_p / (2 g)
///
/// v is the speed of the robot, C_p the pressure coefficient at the port, -C_p rho v^2 / 2 the pressure error
/// (Bernoulli), and rho g height the pressure of a height: the density cancels. A port along the flow sucks (k > 0), one
/// towards it is pressed (k < 0, -1/(2 g) at most). b is everything that moves slowly: offset of the barometers,
/// weather, ventilation; Gauss-Markov. Only changes of the speed show k: at a constant one k and b are inseparable and
/// sigma() stays.
///
/// A driver of the estimator calls add() for every height of the altimeter that is not gated, with the height by other
/// means (lidar, wheels and acceleration), and subtracts correction_m() from later altimeter heights. A height that
/// was made with the correction must be compared without it. As a state of a larger filter it is one row: v^2.
class AirflowEstimator {
 public:
  /// Largest |k| [s^2/m], C_p = 1: the stagnation pressure.
  static constexpr double kLargestCoefficient = 0.051;

  struct Options {
    double coefficient_sigma = 0.02;   ///< a-priori, C_p of 0.4: ports on robots' housings; [s^2/m]
    double bias_sigma_m = 0.2;         ///< of b: ventilation zones and the barometers' offset [m]
    double bias_time_s = 60.0;         ///< correlation time of b
    double turbulence_sigma_m = 0.03;  ///< of the air's own unrest, which is part of the noise
    double turbulence_time_s = 3.0;
  };

  AirflowEstimator() : AirflowEstimator(Options{}) {}
  explicit AirflowEstimator(const Options& options);

  /// @param dt_s time since the call before, >= 0
  /// @param speed_m_s speed through still air
  /// @param residual_m uncorrected altimeter height minus height
  /// @param variance_m2 of the residual's white noise, > 0
  void add(double dt_s, double speed_m_s, double residual_m, double variance_m2);

  /// k [s^2/m]: metres per (m/s)^2.
  [[nodiscard]] double coefficient() const;
  [[nodiscard]] double sigma() const;
  /// Error of the altimeter height at that speed [m], to be subtracted from it, and its variance.
  [[nodiscard]] double correction_m(double speed_m_s) const;
  [[nodiscard]] double correction_variance_m2(double speed_m_s) const;

 private:
  Options options_;
  Eigen::Vector2d x_ = Eigen::Vector2d::Zero();  // b, k
  Eigen::Matrix2d P_;
};

}  // namespace isobar
