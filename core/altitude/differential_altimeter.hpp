// SPDX-License-Identifier: BSD-3-Clause
// Height of the robot's pressure port from its barometer and, where there is one, a static base station's.
#pragma once

#include <cstdint>
#include <limits>

#include "core/altitude/air_temperature.hpp"
#include "core/altitude/altitude_config.hpp"
#include "core/altitude/barometer_monitor.hpp"
#include "core/altitude/base_reference.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/estimates.hpp"
#include "core/samples.hpp"

namespace isobar {

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
  /// With kBaseReturned and kBaseSwitched: by how much height_m moved with the event.
  double weather_shift_m = 0.0;
};

/// Robot against base station; against its own start while there is no base station, which the source says.
/// Heights are continuous when a base joins, jumps, or another one takes over.
class DifferentialAltimeter {
 public:
  explicit DifferentialAltimeter(const AltimeterConfig& config);

  /// The robot's time, from whatever sensor tells it: tells silence and staleness where no pressure comes.
  void set_time(std::int64_t now_ns) { now_ns_ = now_ns; }
  /// Height of the port by dead reckoning [m], NaN where that means nothing (no wheels, an elevator): the
  /// robot's barometer as a witness of two base stations.
  void set_witness(double height_m) { witness_m_ = height_m; }

  /// `sample.stamp_ns` on the robot's clock.
  PressureStatus add_base(const PressureSample& sample);
  /// With kAccepted, and only then, `out` is filled.
  PressureStatus add_robot(const PressureSample& sample, AltimeterReading& out);

  /// The robot's clock jumped: samples follow at once, whatever their stamps. Heights go on as they are.
  void restart_clock();

  /// No usable robot sample for `timeout_s`, or a stuck value, at `now_ns`.
  [[nodiscard]] bool robot_lost(std::int64_t now_ns, double timeout_s) const {
    return robot_.lost(now_ns, timeout_s);
  }
  [[nodiscard]] BarometerFault robot_fault() const { return robot_.fault(now_ns_); }
  [[nodiscard]] BarometerFault base_fault(std::size_t station) const { return base_.fault(station, now_ns_); }
  [[nodiscard]] std::size_t base_active() const { return base_.active(); }
  [[nodiscard]] std::size_t base_usable_count() const { return base_.usable_count(now_ns_); }
  [[nodiscard]] bool base_undecided() const { return base_.undecided(); }

  [[nodiscard]] double air_temperature_c() const { return air_.temperature_c(); }
  /// Metres a unit of ln p at the present air temperature.
  [[nodiscard]] double scale_m() const;
  /// Relative 1-sigma uncertainty of scale_m().
  [[nodiscard]] double scale_uncertainty() const;

 private:
  void learn_noise(const PressureSample& sample, double gap_s);
  void fill_height(const PressureSample& sample, AltimeterReading& out) const;

  AltimeterConfig config_;
  BarometerMonitor robot_;
  NoiseEstimator robot_noise_;
  BaseReference base_;
  AirTemperatureTracker air_;
  double witness_m_ = std::numeric_limits<double>::quiet_NaN();
  double last_pa_ = 0.0;
  double first_noise_variance_m2_ = 0.0;
  std::int64_t now_ns_ = 0;
  std::int64_t first_stamp_ns_ = 0;  // first sample of the robot
  bool started_ = false;
};

}  // namespace isobar
