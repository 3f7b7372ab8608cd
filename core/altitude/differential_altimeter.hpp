// SPDX-License-Identifier: BSD-3-Clause
// Height of the robot's pressure port from its barometer against a static base station's.
#pragma once

#include <cstdint>
#include <limits>

#include "core/altitude/air_temperature.hpp"
#include "core/altitude/altitude_config.hpp"
#include "core/altitude/barometer_monitor.hpp"
#include "core/altitude/base_reference.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_pairs.hpp"
#include "core/estimates.hpp"
#include "core/samples.hpp"

namespace isobar {

/// One height, with what a filter needs to use it.
struct AltimeterReading {
  /// Time of the height: with a base station that of its sample, up to seconds ago.
  std::int64_t stamp_ns = 0;
  double height_m = 0.0;           ///< of the port above its height at the first reading
  double base_air_m = 0.0;         ///< part of height_m that the base station's pressure has made
  double climb_since_m = 0.0;      ///< climb of the port from stamp_ns to the robot's sample, see set_climb()
  double noise_variance_m2 = 0.0;  ///< white noise of this reading
  double scale_m = 1.0;            ///< scale height: height_m = scale_m ln(reference / pressure)
  /// Total: noise of this and of the first reading, age of the base station's pressure, air temperature.
  /// Sensor warm-up is not observable and not included.
  double variance_m2 = 0.0;
  HeightSource source = HeightSource::kNone;  ///< kDifferential or kSingleBarometer
  double base_age_s = 0.0;  ///< age of the base station's pressure; infinite if there never was one
  ReferenceEvent event = ReferenceEvent::kNone;
  /// Step of height_m at kBaseReturned and kBaseSwitched.
  double weather_shift_m = 0.0;
  /// False: the base station's sample of that time is still to come, so that there is no height yet.
  bool complete = true;
};

/// Hypsometric height of the robot's barometer against the base station's, or, without a base station,
/// against the robot's own first pressure (see `source`). Continuous when a base station joins or jumps;
/// steps by weather_shift_m when one returns or takes over.
///
/// While a base station sends, heights come from simultaneous pressures (PressurePairs): as many a second as the
/// slower of both barometers has samples. When it pauses they come from the robot's pressure against the last
/// smoothed reference, with the weather's variance. A height belongs to stamp_ns: the robot's motion is never
/// delayed, but dated.
class DifferentialAltimeter {
 public:
  explicit DifferentialAltimeter(const AltimeterConfig& config);

  /// Continues the datum of an earlier run, before the first sample. `port_height_m`: height of the port above
  /// the datum's zero, the altimeter's bias included, until a known base station is heard.
  void resume(const HeightDatum& datum, double port_height_m);
  /// Fills the base stations of the datum.
  void describe(HeightDatum& datum) const { base_.describe(datum); }
  /// A base station of the resumed datum has not been heard yet.
  [[nodiscard]] bool waits_for_base() const { return base_.ever() && !base_.present(); }

  /// Robot clock, from the newest sample of any sensor: detects silent and stale barometers.
  void set_time(std::int64_t now_ns) { now_ns_ = now_ns; }
  /// Height of the port by dead reckoning [m]; NaN where it is invalid (no wheels, an elevator). Lets the
  /// robot's barometer decide between two base stations.
  void set_witness(double height_m) { witness_m_ = height_m; }

  /// Climb of the port by accelerometer, wheels and attitude, from any zero [m], at the robot's next sample.
  void set_climb(double climb_m) { climb_m_ = climb_m; }

  /// `sample.stamp_ns`: robot clock.
  PressureStatus add_base(const PressureSample& sample);
  /// Fills `out` if and only if it returns kAccepted.
  PressureStatus add_robot(const PressureSample& sample, AltimeterReading& out);

  /// After a jump of the robot's clock: accept the next samples whatever their stamps. Heights continue.
  void restart_clock();

  /// True if at `now_ns` there was no usable robot sample for `timeout_s`, or its value is stuck.
  [[nodiscard]] bool robot_lost(std::int64_t now_ns, double timeout_s) const {
    return robot_.lost(now_ns, timeout_s);
  }
  [[nodiscard]] BarometerFault robot_fault() const { return robot_.fault(now_ns_); }
  [[nodiscard]] BarometerFault base_fault(std::size_t station) const { return base_.fault(station, now_ns_); }
  [[nodiscard]] std::size_t base_active() const { return base_.active(); }
  [[nodiscard]] std::size_t base_usable_count() const { return base_.usable_count(now_ns_); }
  [[nodiscard]] bool base_undecided() const { return base_.undecided(); }

  [[nodiscard]] double air_temperature_c() const { return air_.temperature_c(); }
  /// The thermometer of the robot (0) or of a base station (1, 2) is left out: it contradicts the others.
  [[nodiscard]] bool thermometer_wrong(std::size_t sensor) const { return air_.wrong(sensor); }
  /// Scale height R_dry T_v / g at the present air temperature [m].
  [[nodiscard]] double scale_m() const;
  /// Relative 1-sigma uncertainty of scale_m().
  [[nodiscard]] double scale_uncertainty() const;

 private:
  void learn_noise(const PressureSample& sample, double gap_s);
  void fill_height(const PressureSample& sample, AltimeterReading& out) const;
  void fill_pair(const PressureSample& sample, const PressurePairs::Mean& pair, AltimeterReading& out) const;
  void fill_variance(std::int64_t stamp_ns, double pressure_pa, AltimeterReading& out) const;
  [[nodiscard]] double air_log(std::int64_t stamp_ns) const;
  [[nodiscard]] bool pausing(std::int64_t now_ns) const;

  AltimeterConfig config_;
  BarometerMonitor robot_;
  NoiseEstimator robot_noise_;
  BaseReference base_;
  AirTemperatureTracker air_;
  PressurePairs pairs_;
  double climb_m_ = 0.0;
  double first_height_m_ = 0.0;  // of the port at the first reading
  double first_log_ = 0.0;       // ln of the reference's pressure then [Pa]
  double witness_m_ = std::numeric_limits<double>::quiet_NaN();
  double last_pa_ = 0.0;
  double first_noise_variance_m2_ = 0.0;
  std::int64_t now_ns_ = 0;
  std::int64_t first_stamp_ns_ = 0;  // of the robot
  std::int64_t paired_ns_ = 0;       // last robot sample with a pair
  bool started_ = false;
};

}  // namespace isobar
