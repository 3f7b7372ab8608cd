// SPDX-License-Identifier: BSD-3-Clause
// One base station: its pressure, smoothed, and whether it can be trusted.
#pragma once

#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/barometer_monitor.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_filter.hpp"

namespace isobar {

/// What the weather may do within `age_s`, 1 sigma [Pa]: a rate of 1 to 4 hPa in three hours, 0.025 Pa/s rms,
/// and a random walk of 0.2 Pa/sqrt(s), wind on the building included.
double weather_sigma_pa(double age_s);

/// Smooths by a Kalman filter in the station's own time and holds the value between samples, so a station
/// that is slower than the robot, or arrives late, does no harm.
///
/// A static barometer has no reason to jump: values that no weather explains (a gust into the housing, a
/// door, a fault) are left out, and the last good one is held. A new level that stays is followed without
/// moving the reference; back at the old level, the old calibration holds again.
class BaseStation {
 public:
  explicit BaseStation(const AltimeterConfig& config);

  /// `now_ns`: the robot's time, to tell stale samples.
  PressureStatus add(const PressureSample& sample, std::int64_t now_ns);

  /// ln of the pressure, jumps taken out: changes with the weather alone.
  [[nodiscard]] double value() const;
  /// Relative variance of value() at `age_s` after the last sample.
  [[nodiscard]] double variance(std::int64_t now_ns) const;

  /// Long enough there, neither lost nor jumping: it may be the reference.
  [[nodiscard]] bool ready(std::int64_t now_ns) const;
  /// Nothing usable within the time-out.
  [[nodiscard]] bool lost(std::int64_t now_ns) const;
  [[nodiscard]] BarometerFault fault(std::int64_t now_ns) const;
  [[nodiscard]] bool started() const { return filter_.started(); }
  /// How old the last usable sample is [s]; infinite before the first.
  [[nodiscard]] double age_s(std::int64_t now_ns) const;
  void restart_clock();

 private:
  void rejoin(const PressureSample& sample, double gap_s);
  bool jumps(const PressureSample& sample, double gap_s, double noise_variance_pa2);
  void settle(double pressure_pa);

  AltimeterConfig config_;
  BarometerMonitor monitor_;
  NoiseEstimator noise_;
  PressureFilter filter_;
  double jump_log_ = 0.0;      // taken off value()
  double level_pa_ = 0.0;      // filtered pressure before the first jump
  double candidate_pa_ = 0.0;  // where it has jumped to, a mean of …
  double candidate_count_ = 0.0;
  std::int64_t used_ns_ = 0;   // stamp of the last sample that went into the filter
  std::int64_t since_ns_ = 0;  // there since
  std::int64_t level_ns_ = 0;
  std::int64_t jumping_ns_ = 0;
  std::int64_t candidate_ns_ = 0;
  bool jumping_ = false;
};

}  // namespace isobar
