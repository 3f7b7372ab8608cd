// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/differential_altimeter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/altitude/hypsometry.hpp"
#include "core/altitude/stamp.hpp"

namespace isobar {
namespace {

// A base station is smoothed this long before it becomes the reference: one noisy sample would shift all
// heights.
constexpr double kBaseSettlingS = 1.0;
// Weather no base takes out, as a steady rate, 1 sigma [Pa/s]: 100 Pa an hour.
constexpr double kWeatherRatePaS = 0.03;
// Noise memory in samples: some seconds of a 32 Hz barometer.
constexpr double kNoiseMemorySamples = 200.0;

NoiseEstimator::Options noise_options(const AltimeterConfig& config) {
  return {config.initial_noise_pa, config.noise_floor_pa, config.noise_ceiling_pa, kNoiseMemorySamples};
}

}  // namespace

DifferentialAltimeter::DifferentialAltimeter(const AltimeterConfig& config)
    : config_(config),
      robot_gate_(config),
      base_gate_(config),
      robot_noise_(noise_options(config)),
      base_noise_(noise_options(config)),
      base_filter_(config.base_walk_pa_sqrt_s),
      air_(config.air) {}

double DifferentialAltimeter::scale_m() const {
  return hypsometric_scale_m(air_.temperature_c() + kZeroCelsiusK);
}

double DifferentialAltimeter::scale_uncertainty() const {
  return config_.air.sigma_k / (air_.temperature_c() + kZeroCelsiusK);
}

void DifferentialAltimeter::restart_clock() {
  robot_gate_.restart_clock();
  base_gate_.restart_clock();
  air_.restart_clock();
}

PressureStatus DifferentialAltimeter::add_base(const PressureSample& sample) {
  const bool first = !base_gate_.started();
  const std::int64_t before_ns = base_gate_.fresh_stamp_ns();
  const PressureStatus status = base_gate_.check(sample);
  if (status == PressureStatus::kBadValue || status == PressureStatus::kBadTime) return status;
  air_.add(1, sample.stamp_ns, sample.temperature_c);
  if (status == PressureStatus::kRepeated) return status;
  const double pressure_pa = sample.pressure_pa;
  const double gap_s = first ? 0.0 : std::max(0.0, seconds_between(before_ns, sample.stamp_ns));
  base_since_ns_ = std::min(base_since_ns_, sample.stamp_ns);
  if (first || gap_s > config_.base_timeout_s) {
    base_filter_.restart();
    base_noise_.restart();
    base_since_ns_ = sample.stamp_ns;
  }
  base_noise_.add(pressure_pa);
  base_filter_.add(pressure_pa, gap_s, base_noise_.variance());
  return status;
}

bool DifferentialAltimeter::base_ready(std::int64_t now_ns) const {
  return !base_gate_.lost(now_ns, config_.base_timeout_s) &&
         seconds_between(base_since_ns_, std::max(base_gate_.fresh_stamp_ns(), now_ns)) >= kBaseSettlingS;
}

void DifferentialAltimeter::update_base_state(std::int64_t now_ns, AltimeterReading& out) {
  const bool ready = base_ready(now_ns);
  if (base_ == Base::kPresent && base_gate_.lost(now_ns, config_.base_timeout_s)) {
    base_ = Base::kLost;
    out.event = ReferenceEvent::kBaseLost;
  } else if (base_ == Base::kNever && ready) {
    base_ = Base::kPresent;
    base_offset_log_ = reference_log_pa_ - std::log(base_filter_.pressure_pa());
    out.event = ReferenceEvent::kBaseJoined;
  } else if (base_ == Base::kLost && ready) {
    base_ = Base::kPresent;
    const double held = reference_log_pa_;
    out.event = ReferenceEvent::kBaseReturned;
    out.weather_shift_m = scale_m() * (std::log(base_filter_.pressure_pa()) + base_offset_log_ - held);
  }
  if (base_ == Base::kPresent) reference_log_pa_ = std::log(base_filter_.pressure_pa()) + base_offset_log_;
}

void DifferentialAltimeter::fill_height(const PressureSample& sample, AltimeterReading& out) const {
  const double metres_per_pa = scale_m() / sample.pressure_pa;
  out.stamp_ns = sample.stamp_ns;
  out.scale_m = scale_m();
  out.height_m = out.scale_m * (reference_log_pa_ - std::log(sample.pressure_pa));
  out.noise_variance_m2 = metres_per_pa * metres_per_pa * robot_noise_.variance();
  out.source = base_ == Base::kPresent ? HeightSource::kDifferential : HeightSource::kSingleBarometer;
  out.base_age_s = base_gate_.started()
                       ? std::max(0.0, seconds_between(base_gate_.fresh_stamp_ns(), sample.stamp_ns))
                       : std::numeric_limits<double>::infinity();
  double reference_variance_pa2 = 0.0;
  if (base_ == Base::kPresent) {
    reference_variance_pa2 = base_filter_.variance_pa2(out.base_age_s);
  } else {
    const double alone_s =
        base_ == Base::kLost ? out.base_age_s : seconds_between(first_stamp_ns_, sample.stamp_ns);
    reference_variance_pa2 = std::pow(kWeatherRatePaS * alone_s, 2);
  }
  const double scale_error_m = out.height_m * scale_uncertainty();
  out.variance_m2 = out.noise_variance_m2 + first_noise_variance_m2_ + scale_error_m * scale_error_m +
                    metres_per_pa * metres_per_pa * reference_variance_pa2;
}

PressureStatus DifferentialAltimeter::add_robot(const PressureSample& sample, AltimeterReading& out) {
  const std::int64_t before_ns = robot_gate_.fresh_stamp_ns();
  const PressureStatus status = robot_gate_.check(sample);
  if (status == PressureStatus::kBadValue || status == PressureStatus::kBadTime) return status;
  air_.add(0, sample.stamp_ns, sample.temperature_c);
  if (status == PressureStatus::kRepeated) return status;
  if (started_ && seconds_between(before_ns, sample.stamp_ns) > 1.0) robot_noise_.restart();
  robot_noise_.add(sample.pressure_pa);
  out = AltimeterReading{};
  if (!started_) {
    reference_log_pa_ = std::log(sample.pressure_pa);
    const double metres_per_pa = scale_m() / sample.pressure_pa;
    first_noise_variance_m2_ = metres_per_pa * metres_per_pa * robot_noise_.variance();
    first_stamp_ns_ = sample.stamp_ns;
    started_ = true;
  }
  update_base_state(sample.stamp_ns, out);
  fill_height(sample, out);
  return status;
}

}  // namespace isobar
