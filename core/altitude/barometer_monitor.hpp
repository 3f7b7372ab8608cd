// SPDX-License-Identifier: BSD-3-Clause
// Fault detection of one barometer from its samples.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_gate.hpp"
#include "core/samples.hpp"

namespace isobar {

/// State of a barometer; the most severe fault that applies.
enum class BarometerFault : std::uint8_t {
  kOk,
  kOff,       ///< silent, or never received
  kStuck,     ///< value bit-identical for too long
  kSpiking,   ///< repeated jumps of single values
  kDrifting,  ///< a drift that neither weather nor motion explains
  kWrong,     ///< implausible values, or a jump that neither weather nor motion explains
};

/// White noise of a sample [Pa^2]: the sender's variance, clamped to the configured bounds, else the
/// estimate.
double noise_variance_pa2(const PressureSample& sample, const NoiseEstimator& estimated,
                          const AltimeterConfig& config);

/// Checks one sensor's samples and keeps its fault state. All times on the robot's clock. Time-outs scale
/// with the sensor's sample interval, which is learnt, so that a slow sensor is not silent between two
/// samples.
class BarometerMonitor {
 public:
  explicit BarometerMonitor(const AltimeterConfig& config) : config_(config), gate_(config) {}

  /// `now_ns`: time of arrival.
  PressureStatus check(const PressureSample& sample, std::int64_t now_ns);

  [[nodiscard]] BarometerFault fault(std::int64_t now_ns) const;

  /// True if, by the stamps, no usable sample came for `timeout_s` (at least three of the sensor's
  /// intervals), or the value is stuck.
  [[nodiscard]] bool lost(std::int64_t now_ns, double timeout_s) const;

  [[nodiscard]] const PressureGate& gate() const { return gate_; }
  /// Learnt interval between new values [s]; 0: unknown.
  [[nodiscard]] double interval_s() const { return std::max(interval_s_, fresh_interval_s_); }
  void restart_clock();

 private:
  void learn_interval(std::int64_t now_ns);
  [[nodiscard]] double stuck_after_s() const;

  AltimeterConfig config_;
  PressureGate gate_;
  double interval_s_ = 0.0;        // between samples; 0: unknown
  double fresh_interval_s_ = 0.0;  // between changes of the value; 0: unknown
  double spike_score_ = 0.0;       // number of recent spikes, forgotten exponentially
  std::int64_t arrived_ns_ = 0;
  std::int64_t refused_since_ns_ = 0;
  std::int64_t spike_ns_ = 0;
  bool heard_ = false;
  bool refusing_ = false;  // every sample since refused_since_ns_ was refused
};

}  // namespace isobar
