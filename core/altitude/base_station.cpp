// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/base_station.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Smoothing time before a station becomes the reference: one noisy sample would shift all heights.
constexpr double kSettlingS = 1.0;
// Model of the weather, see weather_sigma_pa().
constexpr double kWeatherRatePaS = 0.025;
constexpr double kWeatherWalkPaSqrtS = 0.2;
// Jump: deviation from the smoothed pressure above both turbulence and this many sigmas of noise.
constexpr double kStillPa = 4.0;
constexpr double kNoiseSigmas = 6.0;
// A new level is accepted once steady for this long: doors and gusts are over by then.
constexpr double kNewLevelS = 5.0;
// Averaging length of a new level, in samples: a second or two at usual rates.
constexpr double kLevelSamples = 30.0;
// A jump that lasts longer is a fault, not a gust.
constexpr double kJumpFaultS = 1.0;
// Possible new levels in a row, each beyond the one before in the same direction: a drift that is too fast for the filter.
constexpr double kDriftLevels = 3.0;
// Upper bound of the filter's lag: at 1 Hz the walk alone would give 8 s, behind which a common ramp of 1 Pa/s is
// 8 Pa.
constexpr double kLongestLagS = 1.5;

}  // namespace

double weather_sigma_pa(double age_s) {
  return std::sqrt(squared(kWeatherRatePaS * age_s) + squared(kWeatherWalkPaSqrtS) * age_s);
}

BaseStation::BaseStation(const AltimeterConfig& config)
    : config_(config),
      monitor_(config),
      noise_({config.initial_noise_pa, config.noise_floor_pa, config.noise_ceiling_pa,
              NoiseEstimator::kBarometerMemorySamples}),
      filter_(config.base_walk_pa_sqrt_s, kLongestLagS),
      air_(config.base_walk_pa_sqrt_s, kLongestLagS) {}

double BaseStation::value() const { return std::log(filter_.pressure_pa()) - jump_log_; }

double BaseStation::variance(std::int64_t now_ns) const {
  // Weather model instead of the filter's walk: valid beyond the time-out, too.
  const double age_s = std::max(0.0, seconds_between(used_ns_, now_ns));
  return (filter_.variance_pa2() + squared(weather_sigma_pa(age_s))) / squared(filter_.pressure_pa());
}

double BaseStation::age_s(std::int64_t now_ns) const {
  return started() ? std::max(0.0, seconds_between(used_ns_, now_ns))
                   : std::numeric_limits<double>::infinity();
}

bool BaseStation::lost(std::int64_t now_ns) const {
  return !started() || monitor_.lost(now_ns, config_.base_timeout_s) ||
         seconds_between(used_ns_, now_ns) > config_.base_timeout_s;
}

bool BaseStation::ready(std::int64_t now_ns) const {
  return !jumping_ && !lost(now_ns) && seconds_between(since_ns_, std::max(used_ns_, now_ns)) >= kSettlingS;
}

BarometerFault BaseStation::fault(std::int64_t now_ns) const {
  const BarometerFault own = monitor_.fault(now_ns);
  if (own != BarometerFault::kOk && own != BarometerFault::kSpiking) return own;
  if (jumping_ && std::abs(level_steps_) >= kDriftLevels) return BarometerFault::kDrifting;
  if (jumping_ && seconds_between(jumping_ns_, now_ns) > kJumpFaultS) return BarometerFault::kWrong;
  return own;
}

void BaseStation::restart_clock() {
  monitor_.restart_clock();
  jumping_ = used_last_ = false;
  // The elapsed time, and so the change by weather, is unknown: the filter starts again.
  restart_filter();
}

void BaseStation::restart_filter() {
  filter_.restart();
  air_.restart();
}

// The robot's air with the same gain, so that what is common to both stays so.
void BaseStation::filter(double pressure_pa, double air_pa, double gap_s, double noise_variance_pa2) {
  filter_.add(pressure_pa, gap_s, noise_variance_pa2);
  if (std::isfinite(air_pa)) {
    air_.add(air_pa, gap_s, noise_variance_pa2);
  } else {
    air_.restart();
  }
}

PressureStatus BaseStation::add(const PressureSample& sample, std::int64_t now_ns, double air_log) {
  used_last_ = false;
  if (plausible_stamp(sample.stamp_ns) && seconds_between(sample.stamp_ns, now_ns) > config_.base_timeout_s)
    return PressureStatus::kStale;
  const PressureStatus status = monitor_.check(sample, now_ns);
  if (status != PressureStatus::kAccepted) return status;
  const double gap_s = std::max(0.0, seconds_between(used_ns_, sample.stamp_ns));
  const double air_pa = std::exp(air_log);
  if (!filter_.started()) {
    since_ns_ = sample.stamp_ns;
    noise_.restart();
  } else if (!jumping_ && gap_s > config_.base_timeout_s) {
    rejoin(sample, gap_s);
  } else if (jumps(sample, gap_s, noise_variance_pa2(sample, noise_, config_), air_pa)) {
    return status;
  }
  noise_.add(sample.pressure_pa);
  const double variance_pa2 = noise_variance_pa2(sample, noise_, config_);
  filter(sample.pressure_pa, air_pa, gap_s, variance_pa2);
  used_ns_ = sample.stamp_ns;
  sample_log_ = std::log(sample.pressure_pa) - jump_log_;
  sample_variance_ = variance_pa2 / squared(sample.pressure_pa);
  used_last_ = true;
  return status;
}

// Return after a silence: a change within the weather model is weather, a larger one is a new level.
void BaseStation::rejoin(const PressureSample& sample, double gap_s) {
  const double moved_pa = sample.pressure_pa - filter_.pressure_pa();
  if (std::abs(moved_pa) > kStillPa + kLargestWeatherSigmas * weather_sigma_pa(gap_s))
    settle(sample.pressure_pa);
  restart_filter();
  noise_.restart();
  since_ns_ = sample.stamp_ns;
}

bool BaseStation::jumps(const PressureSample& sample, double gap_s, double noise_variance_pa2,
                        double air_pa) {
  const double still_pa = std::max(kStillPa, kNoiseSigmas * std::sqrt(noise_variance_pa2));
  const double allowed_pa =
      still_pa + (gap_s > kSettlingS ? kLargestWeatherSigmas * weather_sigma_pa(gap_s) : 0.0);
  const double moved_pa = sample.pressure_pa - filter_.pressure_pa();
  // Change of the robot's air since the filter's level. A disturbance of the robot alone cannot make a jump here:
  // both differences must be large.
  const double common_pa = std::isfinite(air_pa) && air_.started() ? air_pa - air_.pressure_pa() : 0.0;
  if (std::abs(moved_pa) <= allowed_pa || std::abs(moved_pa - common_pa) <= allowed_pa) {
    jumping_ = false;
    return false;
  }
  if (!jumping_) {
    jumping_ = true;
    jumping_ns_ = candidate_ns_ = sample.stamp_ns;
    candidate_pa_ = sample.pressure_pa;
    candidate_count_ = 1.0;
    level_steps_ = 0.0;
    return true;
  }
  if (std::abs(sample.pressure_pa - candidate_pa_) > still_pa) {
    const double direction = std::copysign(1.0, sample.pressure_pa - candidate_pa_);
    level_steps_ = direction * level_steps_ > 0.0 ? level_steps_ + direction : direction;
    candidate_pa_ = sample.pressure_pa;
    candidate_ns_ = sample.stamp_ns;
    candidate_count_ = 1.0;
    return true;
  }
  candidate_count_ = std::min(candidate_count_ + 1.0, kLevelSamples);
  candidate_pa_ += (sample.pressure_pa - candidate_pa_) / candidate_count_;
  if (seconds_between(candidate_ns_, sample.stamp_ns) < kNewLevelS) return true;
  settle(candidate_pa_);
  jumping_ = false;
  restart_filter();
  filter(candidate_pa_, air_pa, 0.0, noise_variance_pa2 / candidate_count_);
  noise_.restart();
  since_ns_ = sample.stamp_ns;
  return false;
}

void BaseStation::settle(double pressure_pa) {
  if (jump_log_ == 0.0) {
    level_pa_ = filter_.pressure_pa();
    level_ns_ = used_ns_;
  }
  const double away_s = std::max(0.0, seconds_between(level_ns_, monitor_.gate().alive_stamp_ns()));
  const bool back = jump_log_ != 0.0 && std::abs(pressure_pa - level_pa_) <
                                            kStillPa + kLargestWeatherSigmas * weather_sigma_pa(away_s);
  jump_log_ = back ? 0.0 : jump_log_ + std::log(pressure_pa / filter_.pressure_pa());
}

}  // namespace isobar
