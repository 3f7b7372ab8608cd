// SPDX-License-Identifier: BSD-3-Clause
// Plausibility checks of pressure samples: range, time, spikes, repeats.
#pragma once

#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Verdict on one sample.
enum class PressureStatus : std::uint8_t {
  kAccepted,
  kBadValue,  ///< not finite, outside the plausible range, or a spike
  kBadTime,   ///< not newer than the previous sample
  kStale,     ///< base stations only: too old by the robot's clock
  kRepeated,  ///< bit-identical to the previous value: polled faster than converted, or stuck
};

/// Checks one sensor's samples.
class PressureGate {
 public:
  explicit PressureGate(const AltimeterConfig& config) : config_(config) {}

  PressureStatus check(const PressureSample& sample);

  /// Stamp of the last accepted sample; undefined before the first.
  [[nodiscard]] std::int64_t fresh_stamp_ns() const { return fresh_stamp_ns_; }
  /// Stamp of the last plausible sample, repeats included.
  [[nodiscard]] std::int64_t alive_stamp_ns() const { return alive_stamp_ns_; }
  /// After a clock jump: accept the next sample whatever its stamp.
  void restart_clock() { time_known_ = false; }
  [[nodiscard]] bool started() const { return started_; }

 private:
  [[nodiscard]] bool is_spike(const PressureSample& sample);

  AltimeterConfig config_;
  double pressure_pa_ = 0.0;    // last accepted
  double candidate_pa_ = 0.0;   // last refused as a spike
  std::uint32_t agreeing_ = 0;  // successive refused samples at one level
  std::int64_t fresh_stamp_ns_ = 0;
  std::int64_t alive_stamp_ns_ = 0;
  bool started_ = false;
  bool time_known_ = false;
};

}  // namespace isobar
