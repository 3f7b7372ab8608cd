// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/inertial_altimeter.hpp"

#include <cmath>

#include "core/stamp.hpp"

namespace isobar {
namespace {

// A longer step between accelerations is a gap, with an unobserved ride at this vertical speed, 1 sigma.
constexpr double kGapS = 0.1;
constexpr double kUnseenSpeedMS = 0.7;
// Largest difference between the times of a height and of the last acceleration.
constexpr double kMaxHeightDelayS = 1.0;

}  // namespace

InertialAltimeter::InertialAltimeter(const HeightConfig& config, double vz_sigma_m_s)
    : config_(config), filter_(config) {
  filter_.start(0.0, vz_sigma_m_s);
}

InertialAltimeter::Status InertialAltimeter::add_acceleration(std::int64_t stamp_ns, double up_m_s2) {
  if (!std::isfinite(up_m_s2)) return Status::kBadValue;
  if (!plausible_stamp(stamp_ns) || (started_ && stamp_ns <= stamp_ns_)) return Status::kBadTime;
  const double dt_s = started_ ? seconds_between(stamp_ns_, stamp_ns) : 0.0;
  stamp_ns_ = stamp_ns;
  started_ = true;
  const bool gap = dt_s > kGapS;
  const double density = config_.accel_noise_m_s_sqrt_s * config_.accel_noise_m_s_sqrt_s;
  filter_.predict(gap ? accel_bias_m_s2() : up_m_s2, dt_s, density, weather_moves_);
  if (!gap) return Status::kUsed;
  const double unseen_m = kUnseenSpeedMS * dt_s;
  filter_.inflate(VerticalFilter::kZ, unseen_m * unseen_m);
  filter_.inflate(VerticalFilter::kVz, kUnseenSpeedMS * kUnseenSpeedMS);
  return Status::kUsed;
}

InertialAltimeter::Status InertialAltimeter::add_height(const AltimeterReading& reading) {
  if (!std::isfinite(reading.height_m) || !(reading.noise_variance_m2 > 0.0)) return Status::kBadValue;
  const double delay_s = seconds_between(reading.stamp_ns, stamp_ns_);
  if (!started_ || std::abs(delay_s) > kMaxHeightDelayS) return Status::kBadTime;
  weather_moves_ = reading.source != HeightSource::kDifferential;
  if (reading.event == ReferenceEvent::kBaseJoined) filter_.fold_weather_into_offset();
  if (reading.event == ReferenceEvent::kBaseReturned) {
    filter_.settle_weather(-reading.weather_shift_m, reading.noise_variance_m2);
  }
  filter_.update_pressure(reading.height_m, delay_s, reading.noise_variance_m2);
  return Status::kUsed;
}

}  // namespace isobar
