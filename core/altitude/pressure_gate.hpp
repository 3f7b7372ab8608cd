// SPDX-License-Identifier: BSD-3-Clause
// Which pressure samples are fit to be used: range, time, spikes, repeats.
#pragma once

#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/samples.hpp"

namespace isobar {

enum class PressureStatus : std::uint8_t {
  kAccepted,
  kBadValue,  ///< not finite, outside the plausible range, or a spike
  kBadTime,   ///< not newer than the one before
  kStale,     ///< of a base station, and too old for the robot's clock
  kRepeated,  ///< bit for bit the value before: polled faster than converted, or stuck
};

/// Checks one sensor's samples.
class PressureGate {
 public:
  explicit PressureGate(const AltimeterConfig& config) : config_(config) {}

  PressureStatus check(const PressureSample& sample);

  /// Time of the last sample whose value was new and usable; meaningless before the first.
  [[nodiscard]] std::int64_t fresh_stamp_ns() const { return fresh_stamp_ns_; }
  /// Time of the last sample that was at least plausible, repeats included.
  [[nodiscard]] std::int64_t alive_stamp_ns() const { return alive_stamp_ns_; }
  /// The clock jumped: the next sample follows at once, whatever its stamp.
  void restart_clock() { time_known_ = false; }
  [[nodiscard]] bool started() const { return started_; }

 private:
  [[nodiscard]] bool is_spike(const PressureSample& sample);

  AltimeterConfig config_;
  double pressure_pa_ = 0.0;   // last one accepted
  double candidate_pa_ = 0.0;  // last refused one
  std::uint32_t agreeing_ = 0;
  std::int64_t fresh_stamp_ns_ = 0;
  std::int64_t alive_stamp_ns_ = 0;
  bool started_ = false;
  bool time_known_ = false;
};

}  // namespace isobar
