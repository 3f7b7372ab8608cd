// SPDX-License-Identifier: BSD-3-Clause
// The one owner of height in the adaptive method: error of the map's height, bias of the altimeter, rides.
//
//     altimeter - z = b + n - d + k v^2 + noise,   db/dt = r
//
//     d   error of the map's height where the robot is [m]: a random walk with the way, because every scan of new
//         ground is laid onto the one before. On a way of 100 m floors and ceilings keep it to 2 to 3 cm.
//     b   bias of the altimeter [m], first-order Gauss-Markov: ventilated zones (1 to 4 Pa), warm-up, weather that the
//         base station does not share; about what the altimeter gained more than the last rides. Without a base
//         station a random walk with the weather.
//     r   drift of b [m/s], first-order Gauss-Markov: barometers that warm up or fail, fronts. Without it a slow drift is
//         shared with d, and moves the map.
//     s   slope of the map's floors [rad], dd/dway = s: constant over a straight drive, while mounts are unknown.
//     n   turbulence, doors [m]: first-order Gauss-Markov over seconds.
//     k   airflow [s^2/m]: C_p / (2 g), C_p the pressure coefficient of the robot's port, because the pressure of its own
//         wind is -C_p rho v^2 / 2 and that of a height rho g (Bernoulli): the density cancels. v is the robot's speed, the
//         air still. A property of the robot, seen when its speed changes, a part of b at
//         a constant one: a slow random walk, because steady wind and loads change it.
//
// Floors, ceilings and stairs know the height to millimetres over metres; the air knows it to decimetres over hours,
// and alone sees an elevator. So a difference between the two is first the altimeter's (b), and only over hundreds of
// metres the map's (d). What the air cannot have done - a pulse, a step, a drift beyond any zone - widens b and moves
// nothing.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/altitude/drift_watch.hpp"
#include "core/estimates.hpp"
#include "core/prior/prior_history.hpp"
#include "core/registration/ride_meter.hpp"
#include "core/squared.hpp"

namespace isobar {

/// Noise of the height and of the altimeter, 1 sigma.
struct MapHeightConfig {
  double map_walk_m_sqrt_m = 0.008;        ///< random walk of the map's height with the way [m/sqrt(m)]
  double bias_sigma_m = 0.15;              ///< altimeter bias: zones [m] …
  double bias_time_s = 450.0;              ///< … and its correlation time [s]
  double start_bias_sigma_m = 0.02;        ///< bias at the start, where it is zero by definition [m]
  double drift_sigma_m_s = 0.0005;         ///< drift of the bias, 0.006 Pa/s [m/s]: fronts, warm-up ...
  double drift_time_s = 200.0;             ///< ... and its correlation time [s]
  double turbulence_sigma_m = 0.05;        ///< turbulence [m] …
  double turbulence_time_s = 8.0;          ///< … and its correlation time [s]
  double weather_walk_m_sqrt_s = 0.02;     ///< bias without a base station [m/sqrt(s)]
  double airflow_sigma_s2_m = 0.02;        ///< airflow: C_p of 0.4, ports on robots' housings [s^2/m] …
  double airflow_walk_s2_m_sqrt_s = 1e-4;  ///< … and its random walk, 0.002 in 400 s [s^2/m/sqrt(s)]
};

/// Tilt of the map, per axis.
struct MapTilt {
  double variance_rad2 = 0.0;  ///< of what is not known of it
  double square_rad2 = 0.0;    ///< second moment, with what is known: the map keeps it
};

/// Owner of the height. Fed with the priors up to each scan, and with each scan's pose.
class MapHeight {
 public:
  /// Largest |k| [s^2/m], C_p = 1: the stagnation pressure.
  static constexpr double kLargestAirflowS2M = 0.051;

  explicit MapHeight(const MapHeightConfig& config = {}) : config_(config) {
    P_(kAirflow, kAirflow) = squared(config.airflow_sigma_s2_m);
  }

  /// Takes the priors up to `stamp_ns`: altimeter readings, acceleration, rides.
  void advance_to(std::int64_t stamp_ns, const PriorHistory& history);

  /// The ground moves: the scans show the cabin, and say nothing of the map.
  [[nodiscard]] bool riding() const { return ride_.riding() || unseen_start_; }
  /// Height gained by moving ground since the last call [m]; add it to the predicted z.
  double take_risen_m();
  /// Variance of z that rides have added and no scan has confirmed [m^2].
  [[nodiscard]] double unconfirmed_variance_m2() const { return unconfirmed_m2_; }

  /// The pose of a scan. `moved_m`: way since the last one. `z_variance_m2`: of z against the map; of dead reckoning
  /// where the scan was not registered.
  /// @return the correction of z that moves the robot, and with it the ground it is about to map [m]
  double update(double z_m, double moved_m, double z_variance_m2, bool registered, const MapTilt& tilt);

  /// Begins at a pose in the map; the altimeter reads `z_m` there. The airflow is kept: it is the robot's.
  void restart();
  /// The map has been moved up by `up_m` where the robot is: not by the altimeter, which departs from it by that much more.
  void follow_map(double up_m);
  /// Forgets the priors, whose clock may have started over; restart() follows.
  void restart_clock();

  /// Altimeter minus height, at the present speed.
  [[nodiscard]] double bias_m() const { return bias_row().dot(x_); }
  [[nodiscard]] double bias_sd_m() const;
  /// What is known of the altimeter.
  [[nodiscard]] AltimeterState altimeter() const;
  /// Variance of the map's height at the robot [m^2].
  [[nodiscard]] double variance_m2() const { return with_start_(kMap, kMap); }
  /// The altimeter departs from the map by more than zones and weather explain: a drift or a fault of a barometer.
  [[nodiscard]] bool altimeter_faulty() const { return faulty_ || drift_.suspect() != DriftSuspect::kNone; }

 private:
  enum State { kMap, kBias, kTurbulence, kSlope, kRate, kAirflow, kStates };
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  /// Forgets all states but the airflow.
  void keep_airflow();
  void take(const Prior& prior);
  void take_reading(const Prior& prior);
  void predict(double dt_s, double moved_m, const MapTilt& tilt);
  static void predict(const Matrix& F, double tilt_rad2, Matrix& P);
  void widen(State state, double variance);
  [[nodiscard]] Vector bias_row() const;
  void measure_speed(double moved_m, double dt_s);
  void measure(double z_m, double dt_s);
  void begin_at(double difference_m);
  void use_innovation(const Vector& h, double variance, double noise_m2, double dt_s);
  void judge_fault();
  void watch_drift(double residual_m);
  void watch_ride(const Prior& prior, bool stands);
  void take_rise();
  void end_ride();

  MapHeightConfig config_;
  RideMeter ride_;
  DriftWatch drift_;
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Zero();
  // Covariance of the same filter, whose gains do not know it, with the slope that the map has from the start: in P_ it
  // would make the map follow a barometer that drifts in the first minute.
  Matrix with_start_ = Matrix::Zero();
  Prior last_;  // the last prior taken
  bool any_ = false;
  bool slope_begun_ = false;
  bool zero_known_ = false;  // altimeter readings are relative to the first one
  double zero_m_ = 0.0;
  double sum_m_ = 0.0;  // altimeter readings since the last update
  double count_ = 0.0;
  double base_sum_m_ = 0.0;   // the base station's part of them
  double speed_sum_ = 0.0;    // squares of the wheels' speed at them [m^2/s^2]
  double speed_m2_s2_ = 0.0;  // mean square of the speed
  double way_m_ = 0.0;        // since the last reading that was compared
  double noise_m2_ = 0.0;     // white, of one reading
  double shift_m_ = 0.0;      // Prior::altimeter_shift_m already taken into the bias
  double taken_m_ = 0.0;      // of RideMeter::risen_m()
  double risen_m_ = 0.0;      // not taken yet
  double unconfirmed_m2_ = 0.0;
  double floor_bias_m_ = 0.0;  // of the altimeter on this floor, learnt on rides: the bias returns to it
  double waited_s_ = 0.0;      // in a ride: since the air saw its end
  double innovation_m_ = 0.0;
  double mean_innovation_m_ = 0.0;
  double outside_s_ = 0.0;  // how long the readings have been outside the gate
  std::int64_t updated_ns_ = 0;
  bool faulty_ = false;
  bool unseen_start_ =
      false;  // riding, and the ride began before the memory: its height is Prior::height_m's
};

}  // namespace isobar
