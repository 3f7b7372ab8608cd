// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/pressure_gate.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"

namespace isobar {
namespace {

// Largest rate of change by motion, allowed across a gap: a fast lift in a high building, 10 m/s.
constexpr double kFastestChangePaS = 120.0;

}  // namespace

bool PressureGate::is_spike(const PressureSample& sample) {
  const double allowed_pa =
      config_.spike_pa + kFastestChangePaS * seconds_between(fresh_stamp_ns_, sample.stamp_ns);
  if (std::abs(sample.pressure_pa - pressure_pa_) <= allowed_pa) {
    agreeing_ = 0;
    return false;
  }
  const bool agrees = agreeing_ > 0 && std::abs(sample.pressure_pa - candidate_pa_) <= config_.spike_pa;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  candidate_pa_ = sample.pressure_pa;
  if (agreeing_ < config_.spike_confirmations) return true;
  agreeing_ = 0;
  return false;
}

PressureStatus PressureGate::check(const PressureSample& sample) {
  // Comparisons in this direction also reject NaN.
  const bool plausible =
      sample.pressure_pa >= config_.min_pressure_pa && sample.pressure_pa <= config_.max_pressure_pa;
  if (!plausible) return PressureStatus::kBadValue;
  if (!plausible_stamp(sample.stamp_ns)) return PressureStatus::kBadTime;
  if (!time_known_) {
    fresh_stamp_ns_ = alive_stamp_ns_ = sample.stamp_ns - 1;
    time_known_ = true;
  }
  if (started_) {
    if (sample.stamp_ns <= alive_stamp_ns_) return PressureStatus::kBadTime;
    if (sample.pressure_pa == pressure_pa_) {
      alive_stamp_ns_ = sample.stamp_ns;
      return PressureStatus::kRepeated;
    }
    if (is_spike(sample)) return PressureStatus::kBadValue;
  }
  started_ = true;
  pressure_pa_ = sample.pressure_pa;
  fresh_stamp_ns_ = alive_stamp_ns_ = sample.stamp_ns;
  return PressureStatus::kAccepted;
}

}  // namespace isobar
