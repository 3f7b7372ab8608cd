// SPDX-License-Identifier: BSD-3-Clause
// Height of the robot's pressure port from its barometer and, where there is one, a static base station's.
#pragma once

#include <cstdint>

#include "core/altitude/air_temperature.hpp"
#include "core/altitude/altitude_config.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_filter.hpp"
#include "core/altitude/pressure_gate.hpp"
#include "core/estimates.hpp"
#include "core/samples.hpp"

namespace isobar {

/// What changed in the reference with this reading; whoever filters the heights must know.
enum class ReferenceEvent : std::uint8_t {
  kNone,
  kBaseJoined,  ///< a base station is there for the first time: weather no longer moves the height from here
                ///< on
  kBaseLost,    ///< its pressure is held from here on: weather moves the height
  kBaseReturned,  ///< the weather since it was lost is now known, see weather_shift_m, and is in height_m
                  ///< already
};

/// One height.
struct AltimeterReading {
  std::int64_t stamp_ns = 0;
  double height_m = 0.0;           ///< port above its place at the first reading
  double noise_variance_m2 = 0.0;  ///< white noise of this reading
  double scale_m = 1.0;            ///< metres a unit of ln p: height_m is this times ln(reference / pressure)
  /// Everything: noise of this and of the first reading, base station's age, air temperature. Not warm-up,
  /// which shows nowhere.
  double variance_m2 = 0.0;
  HeightSource source = HeightSource::kNone;  ///< kDifferential or kSingleBarometer
  double base_age_s = 0.0;  ///< how old the base station's pressure is; infinite if there never was one
  ReferenceEvent event = ReferenceEvent::kNone;
  double weather_shift_m =
      0.0;  ///< with kBaseReturned: by how much height_m moved because the weather became known
};

/// Robot against base station; against its own start while there is no base station, which the source says.
///
/// The base's pressure is smoothed by a Kalman filter in its own time and held between its samples, so a base
/// that is slower than the robot, or arrives late, does no harm. Heights are continuous when a base joins.
class DifferentialAltimeter {
 public:
  explicit DifferentialAltimeter(const AltimeterConfig& config);

  /// `sample.stamp_ns` on the robot's clock.
  PressureStatus add_base(const PressureSample& sample);
  /// With kAccepted, and only then, `out` is filled.
  PressureStatus add_robot(const PressureSample& sample, AltimeterReading& out);

  /// The robot's clock jumped: samples follow at once, whatever their stamps. Heights go on as they are.
  void restart_clock();

  /// No usable robot sample for `timeout_s`, or a stuck value, at `now_ns`.
  [[nodiscard]] bool robot_lost(std::int64_t now_ns, double timeout_s) const {
    return robot_gate_.lost(now_ns, timeout_s);
  }
  [[nodiscard]] double air_temperature_c() const { return air_.temperature_c(); }
  /// Metres a unit of ln p at the present air temperature.
  [[nodiscard]] double scale_m() const;
  /// Relative 1-sigma uncertainty of scale_m().
  [[nodiscard]] double scale_uncertainty() const;

 private:
  enum class Base : std::uint8_t { kNever, kPresent, kLost };

  void update_base_state(std::int64_t now_ns, AltimeterReading& out);
  void fill_height(const PressureSample& sample, AltimeterReading& out) const;
  [[nodiscard]] bool base_ready(std::int64_t now_ns) const;

  AltimeterConfig config_;
  PressureGate robot_gate_;
  PressureGate base_gate_;
  NoiseEstimator robot_noise_;
  NoiseEstimator base_noise_;
  PressureFilter base_filter_;
  AirTemperatureTracker air_;
  Base base_ = Base::kNever;
  double reference_log_pa_ = 0.0;  // ln of the pressure at height 0 of the port, as far as it is known now
  double base_offset_log_ = 0.0;   // reference_log_pa_ = ln(base) + this, once a base has joined
  double first_noise_variance_m2_ = 0.0;
  std::int64_t base_since_ns_ = 0;   // first sample of the base after it was away
  std::int64_t first_stamp_ns_ = 0;  // first sample of the robot
  bool started_ = false;
};

}  // namespace isobar
