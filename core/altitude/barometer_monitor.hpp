// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a barometer, seen from its samples alone.
#pragma once

#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_gate.hpp"
#include "core/samples.hpp"

namespace isobar {

/// State of a barometer; the worst that holds.
enum class BarometerFault : std::uint8_t {
  kOk,
  kOff,       ///< silent, or never heard
  kStuck,     ///< its value does not change by one bit
  kSpiking,   ///< single values jump, again and again
  kDrifting,  ///< it moves as no weather and no height does
  kWrong,     ///< its values are impossible, or have jumped to where nothing can have brought them
};

/// White noise of a sample [Pa^2]: what its sender says, within the configured bounds, else what is seen.
double noise_variance_pa2(const PressureSample& sample, const NoiseEstimator& seen,
                          const AltimeterConfig& config);

/// Checks one sensor's samples and remembers how they were. All times on the robot's clock; a sensor's own
/// rate is learnt, so that a slow one is not silent between two samples.
class BarometerMonitor {
 public:
  explicit BarometerMonitor(const AltimeterConfig& config) : config_(config), gate_(config) {}

  /// `now_ns`: when it arrived.
  PressureStatus check(const PressureSample& sample, std::int64_t now_ns);

  [[nodiscard]] BarometerFault fault(std::int64_t now_ns) const;

  /// No usable sample for `timeout_s` (or three of its own intervals), or a stuck value: by the stamps.
  [[nodiscard]] bool lost(std::int64_t now_ns, double timeout_s) const;

  [[nodiscard]] const PressureGate& gate() const { return gate_; }
  void restart_clock();

 private:
  void learn_interval(std::int64_t now_ns);
  [[nodiscard]] double stuck_after_s() const;

  AltimeterConfig config_;
  PressureGate gate_;
  double interval_s_ = 0.0;        // between samples, 0: not known
  double fresh_interval_s_ = 0.0;  // between values that are new
  double spike_score_ = 0.0;       // spikes of late, forgotten over time
  std::int64_t arrived_ns_ = 0;
  std::int64_t refused_since_ns_ = 0;
  std::int64_t spike_ns_ = 0;
  bool heard_ = false;
  bool refusing_ = false;  // nothing usable since refused_since_ns_
};

}  // namespace isobar
