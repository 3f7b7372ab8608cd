// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/barometer_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Tolerated silence, and time without a change of the value, in the sensor's own sample intervals.
constexpr double kSilentIntervals = 3.0;
constexpr double kUnchangedIntervals = 6.0;
// Tolerated silence after the first sample, while the interval is unknown: base stations send at 1 Hz and faster.
constexpr double kFirstSilenceS = 3.0;
// Longest interval that is learnt: a slower sensor counts as lost between two samples.
constexpr double kLongestIntervalS = 10.0;
// Gain of the interval's exponential mean: a memory of ten samples.
constexpr double kIntervalGain = 0.1;
// Nothing but refused values for this long is a fault, not a spike.
constexpr double kRefusedS = 0.5;
// The spike score counts spikes with exponential forgetting; three spikes within ten seconds exceed the
// limit.
constexpr double kSpikeMemoryS = 10.0;
constexpr double kSpikeScoreLimit = 2.0;

void learn(double& interval_s, double measured_s) {
  measured_s = std::min(measured_s, kLongestIntervalS);
  if (interval_s <= 0.0) {
    interval_s = measured_s;
    return;
  }
  // Clipped at twice the mean: one pause hardly changes it, yet a slower rate is learnt.
  interval_s += kIntervalGain * (std::min(measured_s, 2.0 * interval_s) - interval_s);
}

}  // namespace

double noise_variance_pa2(const PressureSample& sample, const NoiseEstimator& estimated,
                          const AltimeterConfig& config) {
  if (!(sample.variance_pa2 > 0.0)) return estimated.variance();
  return std::clamp(sample.variance_pa2, squared(config.noise_floor_pa), squared(config.noise_ceiling_pa));
}

void BarometerMonitor::learn_interval(std::int64_t now_ns) {
  if (heard_ && now_ns > arrived_ns_) learn(interval_s_, seconds_between(arrived_ns_, now_ns));
  arrived_ns_ = std::max(now_ns, heard_ ? arrived_ns_ : now_ns);
  heard_ = true;
}

PressureStatus BarometerMonitor::check(const PressureSample& sample, std::int64_t now_ns) {
  const bool started = gate_.started();
  const std::int64_t fresh_ns = gate_.fresh_stamp_ns();
  const PressureStatus status = gate_.check(sample);
  if (status == PressureStatus::kBadTime) return status;
  learn_interval(now_ns);
  if (status != PressureStatus::kBadValue) {
    refusing_ = false;
    if (status == PressureStatus::kAccepted && started)
      learn(fresh_interval_s_, seconds_between(fresh_ns, sample.stamp_ns));
    return status;
  }
  if (!refusing_) {
    refusing_ = true;
    refused_since_ns_ = now_ns;
    const double since_s = std::max(0.0, seconds_between(spike_ns_, now_ns));
    spike_score_ = 1.0 + spike_score_ * std::exp(-since_s / kSpikeMemoryS);
    spike_ns_ = now_ns;
  }
  return status;
}

double BarometerMonitor::stuck_after_s() const {
  return std::max(config_.stuck_timeout_s, kUnchangedIntervals * fresh_interval_s_);
}

BarometerFault BarometerMonitor::fault(std::int64_t now_ns) const {
  const double tolerated_s = interval_s_ > 0.0 ? kSilentIntervals * interval_s_ : kFirstSilenceS;
  const double silent_s = std::max(config_.silent_timeout_s, tolerated_s);
  if (!heard_ || seconds_between(arrived_ns_, now_ns) > silent_s) return BarometerFault::kOff;
  if (refusing_ && seconds_between(refused_since_ns_, now_ns) > kRefusedS) return BarometerFault::kWrong;
  if (gate_.started() && seconds_between(gate_.fresh_stamp_ns(), gate_.alive_stamp_ns()) > stuck_after_s())
    return BarometerFault::kStuck;
  const double since_s = std::max(0.0, seconds_between(spike_ns_, now_ns));
  if (spike_score_ * std::exp(-since_s / kSpikeMemoryS) > kSpikeScoreLimit) return BarometerFault::kSpiking;
  return BarometerFault::kOk;
}

bool BarometerMonitor::lost(std::int64_t now_ns, double timeout_s) const {
  if (!gate_.started()) return true;
  timeout_s = std::max(timeout_s, kSilentIntervals * interval_s_);
  return seconds_between(gate_.alive_stamp_ns(), now_ns) > timeout_s ||
         seconds_between(gate_.fresh_stamp_ns(), now_ns) > std::max(stuck_after_s(), timeout_s);
}

void BarometerMonitor::restart_clock() {
  gate_.restart_clock();
  heard_ = refusing_ = false;
  spike_score_ = 0.0;
}

}  // namespace isobar
