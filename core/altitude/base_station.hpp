// SPDX-License-Identifier: BSD-3-Clause
// Smoothed pressure and state of one base station.
#pragma once

#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/barometer_monitor.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_filter.hpp"

namespace isobar {

/// Change of pressure by weather within `age_s`, 1 sigma [Pa]: a rate of 1 to 4 hPa in three hours, 0.025
/// Pa/s rms, plus a random walk of 0.2 Pa/sqrt(s), wind on the building included.
double weather_sigma_pa(double age_s);
/// Largest change by weather in sigmas: a larger one is a jump or a drift of the sensor.
inline constexpr double kLargestWeatherSigmas = 4.0;

/// Kalman filter that runs on the station's stamps and holds its value between samples, so that slow and
/// delayed stations are usable. Its lag is bounded, also at 1 Hz.
///
/// A static barometer does not jump: values that neither weather nor the robot's own barometer explains (a gust
/// into the housing, a door, a fault) are left out and the last good value is held. What the robot's air does, too,
/// is no fault: a ramp or a gust over the whole site. For that comparison the robot's pressure passes the same
/// filter at the same times. A lasting new level is followed without moving the reference: the jump is stored as an
/// offset, which is dropped when the station returns to its old level.
class BaseStation {
 public:
  explicit BaseStation(const AltimeterConfig& config);

  /// `now_ns`: robot clock at arrival, to refuse stale samples. `air_log`: ln of the robot's pressure [Pa] at the
  /// sample's time, its own climb subtracted; NaN: unknown.
  PressureStatus add(const PressureSample& sample, std::int64_t now_ns, double air_log);

  /// True if the last sample added is in the filter: neither refused nor a jump.
  [[nodiscard]] bool used_last() const { return used_last_; }
  /// ln of that sample [Pa] without jumps, not smoothed.
  [[nodiscard]] double sample_log() const { return sample_log_; }
  /// Relative variance of that sample.
  [[nodiscard]] double sample_variance() const { return sample_variance_; }
  /// Learnt sample interval [s]; 0: unknown.
  [[nodiscard]] double interval_s() const { return monitor_.interval_s(); }

  /// ln of the pressure [Pa] without jumps: changes with the weather alone.
  [[nodiscard]] double value() const;
  /// Sum of the jumps that value() leaves out, of ln of the pressure.
  [[nodiscard]] double jump_log() const { return jump_log_; }
  /// Variance of value() (relative variance of the pressure) at `now_ns`.
  [[nodiscard]] double variance(std::int64_t now_ns) const;

  /// Settled, neither lost nor jumping: may be the reference.
  [[nodiscard]] bool ready(std::int64_t now_ns) const;
  /// No usable sample within the time-out.
  [[nodiscard]] bool lost(std::int64_t now_ns) const;
  [[nodiscard]] BarometerFault fault(std::int64_t now_ns) const;
  [[nodiscard]] bool started() const { return filter_.started(); }
  /// Age of the last usable sample [s]; infinite before the first.
  [[nodiscard]] double age_s(std::int64_t now_ns) const;
  void restart_clock();

 private:
  void rejoin(const PressureSample& sample, double gap_s);
  bool jumps(const PressureSample& sample, double gap_s, double noise_variance_pa2, double air_pa);
  void settle(double pressure_pa);
  void filter(double pressure_pa, double air_pa, double gap_s, double noise_variance_pa2);
  void restart_filter();

  AltimeterConfig config_;
  BarometerMonitor monitor_;
  NoiseEstimator noise_;
  PressureFilter filter_;
  PressureFilter air_;            // the robot's, climb subtracted, at this station's times
  double jump_log_ = 0.0;         // sum of followed jumps, subtracted in value()
  double level_pa_ = 0.0;         // filtered pressure before the first jump
  double candidate_pa_ = 0.0;     // mean of the samples at a possible new level
  double candidate_count_ = 0.0;  // their number
  std::int64_t used_ns_ = 0;      // stamp of the last sample in the filter
  std::int64_t since_ns_ = 0;     // start of the present settling
  std::int64_t level_ns_ = 0;
  std::int64_t jumping_ns_ = 0;
  std::int64_t candidate_ns_ = 0;
  double sample_log_ = 0.0;
  double sample_variance_ = 0.0;
  double level_steps_ = 0.0;  // possible new levels in a row that rise; negative: that fall
  bool jumping_ = false;
  bool used_last_ = false;
};

}  // namespace isobar
