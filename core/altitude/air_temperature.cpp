// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/air_temperature.hpp"

#include <algorithm>
#include <cmath>

#include "core/plausibility.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

constexpr std::size_t kRobot = 0;
// A thermometer silent for longer is ignored: its last reading may be from another place.
constexpr double kForgetSensorS = 60.0;
// Step: further from the sensor's own mean than its noise and a cold draught explain. Chips take a minute to follow
// the air.
constexpr double kStepK = 6.0;
constexpr double kFastestChangeKS = 0.2;
// Time with steps only after which the thermometer is wrong: single spikes are not.
constexpr double kSteppedS = 2.0;
// Difference of two thermometers in the same air: the largest usual self-heating, and 2 K of their accuracy.
constexpr double kSameAirK = 10.0;
// The robot's thermometer loses where it is this much further from what is expected than the base station's: it
// stands in the air that counts, so that its word has more weight.
constexpr double kRobotPrecedenceK = 12.0;
// Plausible distance of a single thermometer from the configured temperature: climates and seasons. From an estimate:
// a robot that drives out of a heated building.
constexpr double kAloneK = 45.0;
constexpr double kAloneSettledK = 30.0;
// Self-heating of the robot's sensor where the base station's cannot show it.
constexpr double kRobotHeatK = 1.5;
// Standard deviation of the estimate from leaving a thermometer out, as a share of the difference: the wrong one is
// nearly certain (a step, or three times further from what is expected than any season), or the likelier of two.
constexpr double kClearK = 30.0;
constexpr double kClearShare = 0.05;
constexpr double kLikelyShare = 0.2;
// Air temperature without any thermometer, 1 sigma.
constexpr double kUnknownAirK = 8.0;

}  // namespace

AirTemperatureTracker::AirTemperatureTracker(const AirTemperatureConfig& config)
    : config_(config), estimate_c_(config.fixed_c) {}

double AirTemperatureTracker::sigma_k() const {
  double variance = squared(config_.sigma_k) + squared(kLikelyShare * other_air_k_);
  for (const Thermometer& thermometer : thermometers_) {
    if (thermometer.wrong || thermometer.stepped) variance += squared(thermometer.doubt_k);
  }
  return std::sqrt(variance);
}

bool AirTemperatureTracker::smooth(Thermometer& thermometer, std::int64_t stamp_ns,
                                   double temperature_c) const {
  const double dt_s = seconds_between(thermometer.stamp_ns, stamp_ns);
  if (!thermometer.started || dt_s > kForgetSensorS) {
    const bool known_wrong = thermometer.wrong || thermometer.stepped;
    thermometer = {stamp_ns, temperature_c, 0.0, thermometer.doubt_k, true, false, known_wrong, false};
    return true;
  }
  if (dt_s <= 0.0) return true;
  const double step_k = std::abs(temperature_c - thermometer.smooth_c);
  if (step_k > kStepK + kFastestChangeKS * dt_s) {
    if (dt_s < kSteppedS) return false;
    thermometer.stepped = true;
    thermometer.doubt_k = kClearShare * step_k;
    return false;
  }
  thermometer.stepped = false;
  // Running mean until the smoothing time has passed, exponential afterwards: no start-up transient.
  thermometer.weight_s = std::min(thermometer.weight_s + dt_s, config_.smoothing_time_s);
  const double gain = std::min(1.0, dt_s / (thermometer.weight_s + dt_s));
  thermometer.smooth_c += gain * (temperature_c - thermometer.smooth_c);
  thermometer.stamp_ns = stamp_ns;
  return true;
}

bool AirTemperatureTracker::present(std::size_t sensor, std::int64_t stamp_ns) const {
  const Thermometer& thermometer = thermometers_[sensor];
  return thermometer.started && seconds_between(thermometer.stamp_ns, stamp_ns) < kForgetSensorS;
}

bool AirTemperatureTracker::usable(std::size_t sensor, std::int64_t stamp_ns) const {
  const Thermometer& thermometer = thermometers_[sensor];
  return present(sensor, stamp_ns) && !thermometer.wrong && !thermometer.stepped &&
         (thermometer.judged || !settled_);
}

double AirTemperatureTracker::distance_k(const Thermometer& thermometer) const {
  return std::abs(thermometer.smooth_c - (settled_ ? estimate_c_ : config_.fixed_c));
}

void AirTemperatureTracker::leave_out(Thermometer& loser, const Thermometer& winner) const {
  const bool clear = distance_k(loser) - distance_k(winner) > kClearK;
  loser.wrong = true;
  loser.doubt_k = (clear ? kClearShare : kLikelyShare) * std::abs(loser.smooth_c - winner.smooth_c);
}

void AirTemperatureTracker::judge_alone(Thermometer& thermometer) const {
  if (distance_k(thermometer) <= (settled_ ? kAloneSettledK : kAloneK)) return;
  thermometer.wrong = true;
  thermometer.doubt_k = settled_ ? kClearShare * distance_k(thermometer) : kUnknownAirK;
}

void AirTemperatureTracker::judge(std::size_t sensor, std::int64_t stamp_ns) {
  Thermometer& own = thermometers_[sensor];
  Thermometer& robot = thermometers_[kRobot];
  own.judged = true;
  own.wrong = false;
  bool compared = false;
  for (std::size_t other = 0; other < kSensors; ++other) {
    // Bases are not compared with each other: each has its own air, the robot's decides.
    if (other == sensor || (other != kRobot && sensor != kRobot) || !usable(other, stamp_ns)) continue;
    compared = true;
    Thermometer& base = thermometers_[sensor == kRobot ? other : sensor];
    if (std::abs(base.smooth_c - robot.smooth_c) <= kSameAirK) continue;
    const bool robot_loses = distance_k(robot) > distance_k(base) + kRobotPrecedenceK;
    leave_out(robot_loses ? robot : base, robot_loses ? base : robot);
  }
  if (!compared) judge_alone(own);
}

// Thermometers that are new and have been averaged.
void AirTemperatureTracker::judge_beginnings(std::int64_t stamp_ns) {
  for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
    Thermometer& thermometer = thermometers_[sensor];
    if (!present(sensor, stamp_ns)) continue;
    if (!thermometer.judged && (!settled_ || thermometer.weight_s >= config_.smoothing_time_s)) {
      judge(sensor, stamp_ns);
    }
    // It has come back to the others by itself.
    const double away_k = std::abs(thermometer.smooth_c - estimate_c_);
    if (settled_ && thermometer.wrong && thermometer.judged && away_k < 0.5 * kSameAirK)
      thermometer.wrong = false;
  }
}

bool AirTemperatureTracker::find_coldest(std::int64_t stamp_ns, double& lowest_c) {
  const bool robot_usable = usable(kRobot, stamp_ns);
  const double robot_c = thermometers_[kRobot].smooth_c;
  bool found = robot_usable;
  bool left_out = false;
  bool shared = false;
  lowest_c = robot_usable ? robot_c : kPlausibleTemperatureC.highest;
  other_air_k_ = 0.0;
  for (std::size_t sensor = 1; sensor < kSensors; ++sensor) {
    if (!present(sensor, stamp_ns)) continue;
    const double base_c = thermometers_[sensor].smooth_c;
    if (!usable(sensor, stamp_ns)) {
      left_out = true;
    } else if (robot_usable && robot_c - base_c > kSameAirK) {
      left_out = true;
      other_air_k_ = std::max(other_air_k_, robot_c - base_c);
    } else {
      shared = found = true;
      lowest_c = std::min(lowest_c, base_c);
    }
  }
  if (robot_usable && left_out && !shared) lowest_c -= kRobotHeatK;
  return found;
}

void AirTemperatureTracker::follow(double lowest_c, double dt_s) {
  const double time_s = lowest_c < estimate_c_ ? config_.fall_time_s : config_.rise_time_s;
  estimate_c_ += (lowest_c - estimate_c_) * -std::expm1(-dt_s / time_s);
  // Lower bound, approached with the time constant of a fall so that the height does not jump.
  const double least_c = lowest_c - config_.max_self_heating_k;
  if (estimate_c_ < least_c)
    estimate_c_ += (least_c - estimate_c_) * -std::expm1(-dt_s / config_.fall_time_s);
}

// The height is still zero, so a step does no harm: adopt the coldest mean of the first seconds.
void AirTemperatureTracker::begin(std::int64_t stamp_ns) {
  double lowest_c = 0.0;
  const bool found = find_coldest(stamp_ns, lowest_c);
  estimate_c_ = found ? lowest_c : config_.fixed_c + config_.expected_self_heating_k;
}

void AirTemperatureTracker::settle(std::int64_t stamp_ns) {
  judge_beginnings(stamp_ns);
  begin(stamp_ns);
  settled_ = true;
}

void AirTemperatureTracker::add(std::size_t sensor, std::int64_t stamp_ns, double temperature_c) {
  if (config_.mode == AirTemperatureMode::kFixed || sensor >= kSensors) return;
  if (!kPlausibleTemperatureC.holds(temperature_c)) return;
  if (!smooth(thermometers_[sensor], stamp_ns, temperature_c) && !started_) return;
  if (!started_) {
    start_ns_ = stamp_ns_ = stamp_ns;
    started_ = time_known_ = true;
    begin(stamp_ns);
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
    begin(stamp_ns);
    return;
  }
  if (!settled_) settle(stamp_ns);
  judge_beginnings(stamp_ns);
  double lowest_c = 0.0;
  if (find_coldest(stamp_ns, lowest_c)) follow(lowest_c, dt_s);
}

}  // namespace isobar
