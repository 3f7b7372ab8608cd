// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/differential_altimeter.hpp"

#include <algorithm>
#include <cmath>

#include "core/altitude/hypsometry.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Longest gap between samples whose difference still shows noise.
constexpr double kNoiseGapS = 1.0;
// A base station pauses when it has sent nothing for this many of its intervals, within these bounds: one sample
// lost on a radio link is no pause.
constexpr double kPauseIntervals = 2.5;
constexpr double kShortestPauseS = 0.3;
constexpr double kLongestPauseS = 3.0;

}  // namespace

DifferentialAltimeter::DifferentialAltimeter(const AltimeterConfig& config)
    : config_(config),
      robot_(config),
      robot_noise_({config.initial_noise_pa, config.noise_floor_pa, config.noise_ceiling_pa,
                    NoiseEstimator::kBarometerMemorySamples}),
      base_(config),
      air_(config.air) {}

double DifferentialAltimeter::scale_m() const {
  return hypsometric_scale_m(air_.temperature_c() + kZeroCelsiusK);
}

double DifferentialAltimeter::scale_uncertainty() const {
  return air_.sigma_k() / (air_.temperature_c() + kZeroCelsiusK);
}

void DifferentialAltimeter::resume(const HeightDatum& datum, double port_height_m) {
  base_.resume(datum);
  first_height_m_ = port_height_m;
}

void DifferentialAltimeter::restart_clock() {
  robot_.restart_clock();
  base_.restart_clock();
  pairs_.restart();
  air_.restart_clock();
}

// ln of the robot's pressure with its climb subtracted: what the air of the site does.
double DifferentialAltimeter::air_log(std::int64_t stamp_ns) const {
  if (pairs_.robot().empty()) return std::numeric_limits<double>::quiet_NaN();
  const RobotAir::Value robot = pairs_.robot().at(stamp_ns);
  return robot.log_pa + robot.climb_m / scale_m();
}

PressureStatus DifferentialAltimeter::add_base(const PressureSample& sample) {
  const std::int64_t now_ns = now_ns_ == 0 ? sample.stamp_ns : now_ns_;
  const PressureStatus status = base_.add(sample, now_ns, air_log(sample.stamp_ns));
  if (status == PressureStatus::kAccepted || status == PressureStatus::kRepeated)
    air_.add(1U + sample.station, sample.stamp_ns, sample.temperature_c);
  if (status == PressureStatus::kAccepted) {
    if (const auto reference = base_.reference_sample(sample.station, now_ns)) {
      pairs_.add_base(sample.stamp_ns, reference->log_pa, reference->variance);
    }
  }
  return status;
}

void DifferentialAltimeter::learn_noise(const PressureSample& sample, double gap_s) {
  // Neither a gap nor a jump is noise.
  if (gap_s > kNoiseGapS || std::abs(sample.pressure_pa - last_pa_) > config_.spike_pa)
    robot_noise_.restart();
  robot_noise_.add(sample.pressure_pa);
  last_pa_ = sample.pressure_pa;
}

bool DifferentialAltimeter::pausing(std::int64_t now_ns) const {
  const double pause_s = std::clamp(kPauseIntervals * base_.interval_s(), kShortestPauseS, kLongestPauseS);
  return seconds_between(paired_ns_, now_ns) > pause_s;
}

// Against the base station's last smoothed pressure, or without one.
void DifferentialAltimeter::fill_height(const PressureSample& sample, AltimeterReading& out) const {
  const double metres_per_pa = scale_m() / sample.pressure_pa;
  out.height_m = scale_m() * (base_.log_pa() - std::log(sample.pressure_pa));
  out.noise_variance_m2 = squared(metres_per_pa) * noise_variance_pa2(sample, robot_noise_, config_);
  if (base_.present()) {
    out.noise_variance_m2 += squared(metres_per_pa * weather_sigma_pa(base_.age_s(sample.stamp_ns)));
  }
  fill_variance(sample.stamp_ns, sample.pressure_pa, out);
}

void DifferentialAltimeter::fill_pair(const PressureSample& sample, const PressurePairs::Mean& pair,
                                      AltimeterReading& out) const {
  const double robot_variance =
      noise_variance_pa2(sample, robot_noise_, config_) / squared(sample.pressure_pa);
  out.stamp_ns = sample.stamp_ns - static_cast<std::int64_t>(pair.delay_s * 1e9);
  out.height_m = scale_m() * pair.difference_log;
  out.climb_since_m = climb_m_ - pair.climb_m;
  out.noise_variance_m2 = squared(scale_m()) * (pair.robot_share * robot_variance + pair.base_variance);
  fill_variance(sample.stamp_ns, sample.pressure_pa, out);
}

void DifferentialAltimeter::fill_variance(std::int64_t stamp_ns, double pressure_pa,
                                          AltimeterReading& out) const {
  double reference_variance = 0.0;
  if (base_.present()) {
    reference_variance = base_.variance(stamp_ns);
  } else {
    const double alone_s = base_.ever() ? out.base_age_s : seconds_between(first_stamp_ns_, stamp_ns);
    reference_variance = squared(weather_sigma_pa(alone_s) / pressure_pa);
  }
  const double scale_error_m = out.height_m * scale_uncertainty();
  out.variance_m2 = out.noise_variance_m2 + first_noise_variance_m2_ + squared(scale_error_m) +
                    squared(out.scale_m) * reference_variance;
}

PressureStatus DifferentialAltimeter::add_robot(const PressureSample& sample, AltimeterReading& out) {
  const std::int64_t before_ns = robot_.gate().fresh_stamp_ns();
  const PressureStatus status = robot_.check(sample, now_ns_ == 0 ? sample.stamp_ns : now_ns_);
  if (status == PressureStatus::kBadValue || status == PressureStatus::kBadTime) return status;
  air_.add(0, sample.stamp_ns, sample.temperature_c);
  if (status == PressureStatus::kRepeated) return status;
  learn_noise(sample, started_ ? seconds_between(before_ns, sample.stamp_ns) : 0.0);
  const double log_pa = std::log(sample.pressure_pa);
  if (!started_) {
    first_log_ = log_pa + first_height_m_ / scale_m();
    base_.start(first_log_);
    first_noise_variance_m2_ =
        squared(scale_m() / sample.pressure_pa) * noise_variance_pa2(sample, robot_noise_, config_);
    first_stamp_ns_ = sample.stamp_ns;
    started_ = true;
  }
  out = AltimeterReading{};
  out.stamp_ns = sample.stamp_ns;
  out.scale_m = scale_m();
  out.event = base_.update(sample.stamp_ns, log_pa + witness_m_ / scale_m());
  out.weather_shift_m = scale_m() * base_.shift_log();
  out.source = base_.present() ? HeightSource::kDifferential : HeightSource::kSingleBarometer;
  out.base_age_s = base_.age_s(sample.stamp_ns);
  PressurePairs::Mean pair;
  const bool paired = pairs_.add_robot(sample.stamp_ns, log_pa, climb_m_, pair) && base_.present();
  if (paired || out.event != ReferenceEvent::kNone) paired_ns_ = sample.stamp_ns;
  if (paired && out.event == ReferenceEvent::kNone) {
    fill_pair(sample, pair, out);
    out.base_air_m = scale_m() * (pairs_.robot().at(out.stamp_ns).log_pa + pair.difference_log - first_log_);
  } else {
    fill_height(sample, out);
    out.base_air_m = scale_m() * (base_.log_pa() - first_log_);
    out.complete = out.event != ReferenceEvent::kNone || !base_.present() || pausing(sample.stamp_ns);
  }
  return status;
}

}  // namespace isobar
