// SPDX-License-Identifier: BSD-3-Clause
// Policy around the vertical filter: which measurement is used when.
#pragma once

#include <cstdint>

#include "core/altitude/differential_altimeter.hpp"
#include "core/prior/disturbance_judge.hpp"
#include "core/prior/filter_forks.hpp"
#include "core/prior/moving_ground.hpp"
#include "core/prior/pressure_step.hpp"
#include "core/prior/prior_config.hpp"
#include "core/prior/slew.hpp"
#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// Use of a pressure.
enum class PressureUse : std::uint8_t {
  kUsed,
  kGated,  ///< rejected: outside the gate and undecided
  kStep,   ///< used after a long gating: absorbed by the height or by the step state
};

/// Height of the IMU from acceleration, wheels and pressure.
///
/// Wheels and attitude measure the climb well over seconds, pressure measures the height well over minutes;
/// each enters with its own noise. Two events break the model and are detected:
///
/// - *Moving ground* (elevator): the wheels stand, the robot rises (MovingGround). A fork of the filter that
///   has had no update by the wheels since before the ride replaces it, and the wheels are left out until both
///   agree again.
/// - *Disturbed pressure* (door, gust, ventilation zone, fault): DisturbanceJudge classifies it from
///   acceleration and wheels.
///     pulse    rejected
///     step     becomes a state of its own: the height stays, later pressures still measure changes, and
///              after the step the height is as certain as before it
///     motion   followed: by a step of the height, or by a vertical speed where it is a ramp (a ride whose
///              start was not detected)
class HeightFilter {
 public:
  explicit HeightFilter(const HeightConfig& config);

  void start(double z_m, double vz_sigma_m_s);
  /// Continues the height of an earlier run (VerticalFilter::resume()).
  void resume(const VerticalFilter::Continuation& from);
  [[nodiscard]] bool started() const { return started_; }
  /// Offset between the barometers [m].
  [[nodiscard]] double offset_m() const { return filter_.value(VerticalFilter::kOffset); }
  [[nodiscard]] double offset_variance_m2() const { return filter_.variance(VerticalFilter::kOffset); }
  [[nodiscard]] bool step_open() const { return filter_.step_open(); }

  /// `accel_density`: noise of the vertical acceleration [m^2/s^3].
  void predict(double up_accel_m_s2, double dt_s, double accel_density);

  /// A gap of `dt_s`: adds the variance of an unobserved ride.
  void bridge(double dt_s);

  /// Mean climb speed of the IMU over the last `dt_s` from wheels and attitude; `forward_m_s` along the
  /// ground; variance of roll and pitch.
  void update_climb(double climb_m_s, double forward_m_s, double dt_s, double attitude_variance_rad2);

  /// Without wheels and pressure: zero vertical speed with the variance of a bounded one, over the last
  /// `dt_s`.
  void update_bounded_speed(double dt_s);

  /// `lever_m`: height of the pressure port above the IMU. `now_ns`: time of the last predict().
  PressureUse update_pressure(const AltimeterReading& reading, double lever_m, std::int64_t now_ns);

  /// Reported height: corrections after the return or the switch of a base station enter at a limited rate.
  [[nodiscard]] double z_m() const { return filter_.value(VerticalFilter::kZ) + slew_.rest_m(); }
  [[nodiscard]] double vz_m_s() const { return filter_.value(VerticalFilter::kVz); }
  [[nodiscard]] double variance_m2() const;
  /// Estimated offset of the barometric height: barometers, local pressure, weather and steps together.
  [[nodiscard]] double pressure_bias_m() const { return filter_.pressure_bias_m(); }
  [[nodiscard]] double pressure_bias_variance_m2() const { return filter_.pressure_bias_variance_m2(); }
  [[nodiscard]] bool ground_moves() const { return ground_.moves(); }
  /// State of the innovation monitor.
  [[nodiscard]] const DisturbanceJudge& disturbance() const { return judge_; }
  /// The error of the pressure exceeds any weather or ventilation: a sensor fault, gated or subtracted.
  [[nodiscard]] bool pressure_faulty() const { return faulty_; }

 private:
  void handle_event(const AltimeterReading& reading);
  PressureUse use_pressure(const AltimeterReading& reading, double lever_m, double delay_s);
  [[nodiscard]] DisturbanceJudge::Evidence evidence_of(const AltimeterReading& reading, double lever_m,
                                                       double delay_s) const;
  void roll_back();
  void compare_fork(const AltimeterReading& reading, double lever_m, double delay_s, double innovation_m);
  void open_step(const AltimeterReading& reading, const DisturbanceJudge::Evidence& evidence);
  void follow(const VerticalFilter::Innovation& innovation);
  void restart_forks();

  HeightConfig config_;
  VerticalFilter filter_;
  FilterForks forks_;
  MovingGround ground_;
  DisturbanceJudge judge_;
  PressureStep step_;
  Slew slew_;
  double since_climb_s_ = 1e9;  // since the last update by the wheels
  double alone_s_ = 0.0;        // time without a base station
  bool faulty_ = false;
  bool rolled_back_ = false;  // in this disturbance
  bool weather_moves_ = true;
  bool started_ = false;
};

}  // namespace isobar
