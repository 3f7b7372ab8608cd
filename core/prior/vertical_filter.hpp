// SPDX-License-Identifier: BSD-3-Clause
// The vertical Kalman filter: equations without policy.
#pragma once

#include <Eigen/Core>

#include "core/prior/prior_config.hpp"

namespace isobar {

/// Height of the IMU in a gravity-aligned world.
///
/// States: z [m], vz [m/s], b_a bias of the vertical acceleration [m/s^2], s slope error of the wheels [rad],
/// b_p offset between the barometers [m], n slow local pressure noise (Gauss-Markov) [m],
/// w weather since the base station was lost [m] and r its rate [m/s], q a step of the pressure without
/// motion (ventilation zone, fault) [m].
///
///   dz/dt = vz,  dvz/dt = a_up - b_a,  dw/dt = r (+ walk),  wheels' climb = vz - s v_forward
///   barometer = z + b_p + n + w + q (+ lever arm)
class VerticalFilter {
 public:
  enum State { kZ, kVz, kAccelBias, kSlope, kOffset, kTurbulence, kWeather, kWeatherRate, kStep, kStates };
  /// Correlation time of the weather's rate [s]: how long a front moves the pressure one way.
  static constexpr double kWeatherRateTimeS = 7'200.0;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  explicit VerticalFilter(const HeightConfig& config);

  /// Starts at height `z_m`, exactly, with a vertical speed of 0, 1 sigma `vz_sigma_m_s`.
  void start(double z_m, double vz_sigma_m_s);

  /// Height of an earlier run, at its continuation.
  struct Continuation {
    double z_m = 0.0;
    double variance_m2 = 0.0;  ///< of z_m, that of the offset included
    double vz_m_s = 0.0;
    double vz_sigma_m_s = 0.0;
    double offset_m = 0.0;  ///< between the barometers, fixed
    bool may_ride = false;  ///< for HeightFilter: the ground may be moving, as in an elevator
  };
  /// Continues the height of an earlier run.
  void resume(const Continuation& from);

  /// `accel_density`: [m^2/s^3], spectral density of the acceleration's noise. `weather_moves`: no base
  /// station.
  void predict(double up_accel_m_s2, double dt_s, double accel_density, bool weather_moves);

  struct Innovation {
    double value = 0.0;
    double variance = 1.0;
  };

  /// Innovation of a barometric height of the IMU, measured `delay_s` ago.
  [[nodiscard]] Innovation pressure_innovation(double height_m, double delay_s, double variance_m2) const;
  /// The same with the step q taken as zero: the innovation if the step is over.
  [[nodiscard]] Innovation innovation_without_step(double height_m, double delay_s, double variance_m2) const;
  void update_pressure(double height_m, double delay_s, double variance_m2);

  /// Innovation of the vertical speed from wheels and attitude, at forward speed `forward_m_s`.
  [[nodiscard]] Innovation climb_innovation(double climb_m_s, double forward_m_s, double variance) const;
  void update_climb(double climb_m_s, double forward_m_s, double variance);

  /// The base station is lost: the weather's rate becomes unknown, with its a-priori variance.
  void release_weather();
  /// Measurement of the weather since the base station was lost. The state w is zero afterwards.
  void settle_weather(double weather_m, double variance_m2);
  /// A base station has joined: the weather so far becomes part of the constant offset.
  void fold_weather_into_offset();

  /// The pressure has stepped: the state q becomes unknown, to be estimated by the next update. `sigma_m`:
  /// its a-priori standard deviation, far above the step. The offset's estimate is kept for the end of the
  /// step.
  void open_step(double sigma_m);
  /// The step is over: the pressure is back at its old level.
  void close_step();
  [[nodiscard]] bool step_open() const { return step_open_; }

  void inflate(State state, double variance) { P_(state, state) += variance; }

  [[nodiscard]] double value(State state) const { return x_[state]; }
  [[nodiscard]] double variance(State state) const { return P_(state, state); }
  [[nodiscard]] const Matrix& covariance() const { return P_; }
  /// b_p + n + w + q: barometric height minus height.
  [[nodiscard]] double pressure_bias_m() const;
  [[nodiscard]] double pressure_bias_variance_m2() const;

 private:
  [[nodiscard]] Vector pressure_row(double delay_s) const;
  [[nodiscard]] Vector climb_row(double forward_m_s) const;
  [[nodiscard]] Innovation innovation(const Vector& h, double measured, double variance) const;
  void age_offset(double dt_s);
  void drift_weather(double dt_s);
  void forget(State state);
  void update(const Vector& h, double measured, double variance);

  HeightConfig config_;
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Zero();
  double offset_age_s_ = -1.0;  // since the first pressure; negative before it
  bool step_open_ = false;
};

}  // namespace isobar
