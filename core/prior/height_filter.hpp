// SPDX-License-Identifier: BSD-3-Clause
// Policy around the vertical filter: which measurement is believed when.
#pragma once

#include <array>
#include <cstdint>

#include "core/altitude/differential_altimeter.hpp"
#include "core/prior/disturbance_judge.hpp"
#include "core/prior/prior_config.hpp"
#include "core/prior/slew.hpp"
#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// What became of a pressure.
enum class PressureUse : std::uint8_t {
  kUsed,
  kGated,  ///< too far off, and not yet understood
  kStep,   ///< too far off for so long that the height was moved to it, or the pressure's own step
};

/// Height of the IMU's place from acceleration, wheels and pressure.
///
/// Wheels and attitude tell the climb well over seconds, pressure tells the height well over minutes; each
/// enters with its own noise. Two things break the model, and are watched for:
///
/// - *The ground moves* (elevator): the wheels stand, the robot rises. Two copies of the filter run along
/// without the
///   wheels, forked one to three seconds ago. Where such a fork's vertical speed leaves the wheels', the fork
///   becomes the filter (it has not been held down since before the ride began) and the wheels are left out
///   until both agree again.
/// - *The pressure jumps* (door, gust, ventilation zone, fault): DisturbanceJudge tells from acceleration and
/// wheels what it is.
///   A pulse is left out. A step becomes a state of its own: the height stays, the pressure goes on telling
///   changes, and when the step is undone the height is as sure as before it. Only what crept away is
///   followed: by a step of the height, or by a vertical speed where it ramps (a ride whose start was not
///   felt).
class HeightFilter {
 public:
  explicit HeightFilter(const HeightConfig& config);

  void start(double z_m, double vz_sigma_m_s);
  [[nodiscard]] bool started() const { return started_; }

  /// `accel_density`: noise of the vertical acceleration [m^2/s^3].
  void predict(double up_accel_m_s2, double dt_s, double accel_density);

  /// Nothing was known for `dt_s`: the height may have moved.
  void bridge(double dt_s);

  /// Mean climb speed of the IMU's place over the last `dt_s` as the wheels have it [m/s]; `forward_m_s`
  /// along the ground; `attitude_variance` of pitch [rad^2].
  void update_climb(double climb_m_s, double forward_m_s, double dt_s, double attitude_variance);

  /// Neither wheels nor pressure over the last `dt_s`: the vertical speed is only known to be bounded.
  void update_bounded_speed(double dt_s);

  /// `lever_m`: height of the pressure port above the IMU's place. `now_ns`: time of the last predict().
  PressureUse update_pressure(const AltimeterReading& reading, double lever_m, std::int64_t now_ns);

  /// As reported: corrections by a reference that came back are taken in slowly.
  [[nodiscard]] double z_m() const { return filter_.value(VerticalFilter::kZ) + slew_.rest_m(); }
  [[nodiscard]] double vz_m_s() const { return filter_.value(VerticalFilter::kVz); }
  [[nodiscard]] double variance_m2() const;
  [[nodiscard]] bool ground_moves() const { return ground_moves_; }
  /// What the pressure is disturbed by, if it is.
  [[nodiscard]] const DisturbanceJudge& disturbance() const { return judge_; }
  /// The pressure is off by more than any air: a fault, and so far taken off.
  [[nodiscard]] bool pressure_faulty() const { return faulty_; }
  [[nodiscard]] const VerticalFilter& filter() const { return filter_; }

 private:
  struct Fork {
    VerticalFilter filter;
    double age_s = 0.0;
  };

  void handle_event(const AltimeterReading& reading);
  PressureUse use_pressure(const AltimeterReading& reading, double lever_m, double delay_s);
  [[nodiscard]] DisturbanceJudge::Evidence evidence_of(const AltimeterReading& reading, double lever_m,
                                                       double delay_s) const;
  void roll_back();
  void compare_fork(const AltimeterReading& reading, double lever_m, double delay_s, double innovation_m);
  void open_step(const AltimeterReading& reading, const DisturbanceJudge::Evidence& evidence);
  void close_step();
  [[nodiscard]] double without_fault_m(const AltimeterReading& reading) const;
  void follow(const VerticalFilter::Innovation& innovation);
  void watch_ground(double climb_m_s, double forward_m_s, double dt_s, double speed_variance);
  void restart_forks();
  [[nodiscard]] const Fork& older_fork() const {
    return forks_[0].age_s >= forks_[1].age_s ? forks_[0] : forks_[1];
  }
  [[nodiscard]] Fork& older_fork() { return forks_[0].age_s >= forks_[1].age_s ? forks_[0] : forks_[1]; }

  HeightConfig config_;
  VerticalFilter filter_;
  std::array<Fork, 2> forks_;
  double accel_m_s2_ = 0.0;  // vertical, low-passed
  double agreeing_s_ = 0.0;  // how long wheels and filter have agreed again
  double disagreeing_s_ = 0.0;
  double fork_misfit_m_ = 0.0;  // how much worse the older fork fitted the last pressure that was used
  DisturbanceJudge judge_;
  double fault_share_ = 0.0;  // pressure that an open step adds, as a share of the reference pressure
  Slew slew_;
  double since_climb_s_ = 1e9;  // since the wheels were heard
  double alone_s_ = 0.0;        // how long there has been no base station
  bool faulty_ = false;
  bool rolled_back_ = false;  // in this disturbance
  bool ground_moves_ = false;
  bool weather_moves_ = true;
  bool started_ = false;
};

}  // namespace isobar
