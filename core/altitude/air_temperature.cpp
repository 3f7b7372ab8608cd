// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/air_temperature.hpp"

#include <algorithm>
#include <cmath>

#include "core/plausibility.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// A thermometer silent for longer is ignored: its last reading may be from another place.
constexpr double kForgetSensorS = 60.0;

}  // namespace

AirTemperatureTracker::AirTemperatureTracker(const AirTemperatureConfig& config)
    : config_(config), estimate_c_(config.fixed_c) {}

void AirTemperatureTracker::smooth(Thermometer& thermometer, std::int64_t stamp_ns,
                                   double temperature_c) const {
  const double dt_s = seconds_between(thermometer.stamp_ns, stamp_ns);
  if (!thermometer.started || dt_s > kForgetSensorS) {
    thermometer = {stamp_ns, temperature_c, 0.0, true};
    return;
  }
  if (dt_s <= 0.0) return;
  // Running mean until the smoothing time has passed, exponential afterwards: no start-up transient.
  thermometer.weight_s = std::min(thermometer.weight_s + dt_s, config_.smoothing_time_s);
  const double gain = std::min(1.0, dt_s / (thermometer.weight_s + dt_s));
  thermometer.smooth_c += gain * (temperature_c - thermometer.smooth_c);
  thermometer.stamp_ns = stamp_ns;
}

void AirTemperatureTracker::follow(double lowest_c, double dt_s) {
  const double time_s = lowest_c < estimate_c_ ? config_.fall_time_s : config_.rise_time_s;
  estimate_c_ += (lowest_c - estimate_c_) * -std::expm1(-dt_s / time_s);
  // Lower bound, approached with the time constant of a fall so that the height does not jump.
  const double least_c = lowest_c - config_.max_self_heating_k;
  if (estimate_c_ < least_c)
    estimate_c_ += (least_c - estimate_c_) * -std::expm1(-dt_s / config_.fall_time_s);
}

void AirTemperatureTracker::add(std::size_t sensor, std::int64_t stamp_ns, double temperature_c) {
  if (config_.mode == AirTemperatureMode::kFixed || sensor >= kSensors) return;
  if (!kPlausibleTemperatureC.holds(temperature_c)) return;
  smooth(thermometers_[sensor], stamp_ns, temperature_c);
  double lowest_c = kPlausibleTemperatureC.highest;
  for (const Thermometer& thermometer : thermometers_) {
    const double age_s = seconds_between(thermometer.stamp_ns, stamp_ns);
    if (thermometer.started && age_s < kForgetSensorS) lowest_c = std::min(lowest_c, thermometer.smooth_c);
  }
  if (!started_) {
    start_ns_ = stamp_ns_ = stamp_ns;
    estimate_c_ = lowest_c;
    started_ = time_known_ = true;
    return;
  }
  if (!time_known_) {
    start_ns_ = stamp_ns - (stamp_ns_ - start_ns_);
    stamp_ns_ = stamp_ns;
    time_known_ = true;
    return;
  }
  if (stamp_ns <= stamp_ns_) return;
  const double since_start_s = seconds_between(start_ns_, stamp_ns);
  const double dt_s = seconds_between(stamp_ns_, stamp_ns);
  stamp_ns_ = stamp_ns;
  if (since_start_s < config_.smoothing_time_s) {
    // The height is still zero, so a step does no harm: adopt the coldest mean of the first seconds.
    estimate_c_ = lowest_c;
    return;
  }
  follow(lowest_c, dt_s);
}

}  // namespace isobar
