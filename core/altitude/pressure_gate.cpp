// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/pressure_gate.hpp"

#include <algorithm>
#include <cmath>

#include "core/altitude/stamp.hpp"

namespace isobar {
namespace {

// A fast lift in a high building: 10 m/s are 120 Pa/s. What a sensor may move while nobody looked.
constexpr double kFastestChangePaS = 120.0;
// Share of a sample in the level from which a jump is measured: less noise than one sample, little lag.
constexpr double kLevelShare = 0.2;
// A sensor that jumps back to within this is where it was [Pa]: then the jumps have left no error behind.
constexpr double kBackPa = 20.0;

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
  candidate_sum_ = agrees ? candidate_sum_ + sample.pressure_pa : sample.pressure_pa;
  candidate_pa_ = sample.pressure_pa;
  if (agreeing_ < config_.spike_confirmations) return true;
  settle_jump();
  agreeing_ = 0;
  return false;
}

void PressureGate::settle_jump() {
  const double new_level_pa = candidate_sum_ / agreeing_;
  jumped_pa_ += new_level_pa - level_pa_;
  if (std::abs(jumped_pa_) < kBackPa) jumped_pa_ = 0.0;
  level_pa_ = new_level_pa;
}

PressureStatus PressureGate::check(const PressureSample& sample) {
  // Written so that NaN fails.
  const auto holds = [this](double pressure_pa) {
    return pressure_pa >= config_.min_pressure_pa && pressure_pa <= config_.max_pressure_pa;
  };
  const bool plausible =
      holds(sample.pressure_pa) && (agreeing_ > 0 || holds(sample.pressure_pa - jumped_pa_));
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
  level_pa_ = started_ ? level_pa_ + kLevelShare * (sample.pressure_pa - level_pa_) : sample.pressure_pa;
  started_ = true;
  pressure_pa_ = sample.pressure_pa;
  fresh_stamp_ns_ = alive_stamp_ns_ = sample.stamp_ns;
  return PressureStatus::kAccepted;
}

bool PressureGate::lost(std::int64_t now_ns, double timeout_s) const {
  if (!started_) return true;
  return seconds_between(alive_stamp_ns_, now_ns) > timeout_s ||
         seconds_between(fresh_stamp_ns_, now_ns) > std::max(config_.stuck_timeout_s, timeout_s);
}

}  // namespace isobar
