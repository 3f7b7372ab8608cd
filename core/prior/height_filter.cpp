// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/height_filter.hpp"

#include <algorithm>
#include <cmath>

#include "core/altitude/stamp.hpp"

namespace isobar {
namespace {

// Each fork lives this long; the older of the two is always between one and two halves old.
constexpr double kForkLifeS = 3.0;
// A fork younger than this has not left the filter yet.
constexpr double kForkMinAgeS = 0.5;
// The wheels must disagree for this long before the ground is said to move: longer than a bump.
constexpr double kDisagreementS = 0.08;
// Low-pass of the vertical acceleration that tells the end of a ride, and what counts as none.
constexpr double kAccelSmoothingS = 0.3;
constexpr double kQuietAccel = 0.12;
// Vertical speed of something that is neither on wheels nor measured, 1 sigma, and how long it lasts.
constexpr double kBoundedSpeed = 0.3;
constexpr double kBoundedSpeedS = 2.0;
// A ride during a gap: vertical speed 1 sigma.
constexpr double kRideSpeed = 0.7;
// In a ride nothing but pressure holds the vertical speed: a door leaves it off by 0.3 m/s, so the gate opens
// sooner.
constexpr double kRideGateS = 1.0;
// Delay of a pressure sample that is still compensated for.
constexpr double kMaxDelayS = 1.0;
// A pressure that kept moving by more than this share of its offset is a ramp, not a step.
constexpr double kRampShare = 0.5;
constexpr double kRampMinM = 0.3;
// Faster than this no height leaves what acceleration and wheels predict: the pressure itself has stepped.
constexpr double kStepMinM = 0.3;
constexpr double kUnfeltSpeed = 2.0;

double squared(double x) { return x * x; }

}  // namespace

HeightFilter::HeightFilter(const HeightConfig& config)
    : config_(config),
      filter_(config),
      forks_{Fork{VerticalFilter(config), 0.0}, Fork{VerticalFilter(config), 0.0}} {}

void HeightFilter::start(double z_m, double vz_sigma_m_s) {
  filter_.start(z_m, vz_sigma_m_s);
  restart_forks();
  ground_moves_ = false;
  gated_ = false;
  started_ = true;
}

void HeightFilter::restart_forks() {
  for (Fork& fork : forks_) fork = {filter_, 0.0};
  disagreeing_s_ = 0.0;
}

void HeightFilter::predict(double up_accel_m_s2, double dt_s, double accel_density) {
  const double density = std::max(accel_density, squared(config_.accel_noise_m_s_sqrt_s));
  filter_.predict(up_accel_m_s2, dt_s, density, weather_moves_);
  const double accel = up_accel_m_s2 - filter_.value(VerticalFilter::kAccelBias);
  accel_m_s2_ += (accel - accel_m_s2_) * -std::expm1(-dt_s / kAccelSmoothingS);
  for (Fork& fork : forks_) {
    fork.filter.predict(up_accel_m_s2, dt_s, density, weather_moves_);
    fork.age_s += dt_s;
  }
  Fork& older = older_fork();
  if (older.age_s < kForkLifeS) return;
  // The other one is half as old from now on: together they always offer a past before a ride's start.
  older = {filter_, 0.0};
  Fork& other = older_fork();
  other.age_s = std::min(other.age_s, 0.5 * kForkLifeS);
}

void HeightFilter::bridge(double dt_s) {
  filter_.inflate(VerticalFilter::kZ, squared(kRideSpeed * dt_s));
  filter_.inflate(VerticalFilter::kVz, squared(std::min(kRideSpeed, kRideSpeed * dt_s)));
  restart_forks();
  gated_ = false;
  has_used_ = false;
}

void HeightFilter::update_climb(double climb_m_s, double forward_m_s, double dt_s, double attitude_variance) {
  // Errors that last for a while, as white noise of the same effect: density 2 tau sigma^2.
  const double slope_variance =
      squared(config_.slope_error_rad) + std::max(0.0, attitude_variance - squared(config_.slope_sigma_rad));
  const double speed_variance =
      slope_variance * squared(forward_m_s) + squared(config_.slip_share * climb_m_s);
  const double density = 2.0 * config_.slope_error_correlation_s * slope_variance * squared(forward_m_s) +
                         2.0 * config_.slip_correlation_s * squared(config_.slip_share * climb_m_s) +
                         squared(config_.rest_speed_m_s_sqrt_s);
  watch_ground(climb_m_s, forward_m_s, dt_s, speed_variance);
  if (!ground_moves_) filter_.update_climb(climb_m_s, forward_m_s, density / dt_s);
}

void HeightFilter::watch_ground(double climb_m_s, double forward_m_s, double dt_s, double speed_variance) {
  if (!ground_moves_) {
    const Fork& fork = older_fork();
    if (fork.age_s < kForkMinAgeS) return;
    const auto innovation = fork.filter.climb_innovation(climb_m_s, forward_m_s, speed_variance);
    const double limit = std::max(config_.moving_ground_speed_m_s,
                                  config_.moving_ground_sigma * std::sqrt(innovation.variance));
    disagreeing_s_ = std::abs(innovation.value) > limit ? disagreeing_s_ + dt_s : 0.0;
    if (disagreeing_s_ < kDisagreementS) return;
    filter_ = fork.filter;
    ground_moves_ = true;
    agreeing_s_ = 0.0;
    return;
  }
  const auto innovation = filter_.climb_innovation(climb_m_s, forward_m_s, speed_variance);
  const double limit = config_.ground_stopped_speed_m_s + 2.0 * std::sqrt(innovation.variance);
  const bool agree = std::abs(innovation.value) < limit && std::abs(accel_m_s2_) < kQuietAccel;
  agreeing_s_ = agree ? agreeing_s_ + dt_s : 0.0;
  if (agreeing_s_ < config_.ground_stopped_time_s) return;
  ground_moves_ = false;
  restart_forks();
}

void HeightFilter::update_bounded_speed(double dt_s) {
  filter_.update_climb(0.0, 0.0, squared(kBoundedSpeed) * std::max(1.0, 2.0 * kBoundedSpeedS / dt_s));
}

void HeightFilter::handle_event(const AltimeterReading& reading) {
  weather_moves_ = reading.source != HeightSource::kDifferential;
  const auto apply = [&](VerticalFilter& filter) {
    if (reading.event == ReferenceEvent::kBaseJoined) filter.fold_weather_into_offset();
    // The height reading moved by minus the weather that had crept into it.
    if (reading.event == ReferenceEvent::kBaseReturned) {
      filter.settle_weather(-reading.weather_shift_m, reading.noise_variance_m2);
    }
  };
  apply(filter_);
  for (Fork& fork : forks_) apply(fork.filter);
}

PressureUse HeightFilter::update_pressure(const AltimeterReading& reading, double lever_m,
                                          std::int64_t now_ns) {
  if (!started_) return PressureUse::kGated;
  handle_event(reading);
  const double height_m = reading.height_m - lever_m;
  const double delay_s = std::clamp(seconds_between(reading.stamp_ns, now_ns), 0.0, kMaxDelayS);
  const auto innovation = filter_.pressure_innovation(height_m, delay_s, reading.noise_variance_m2);
  const PressureUse use = gate(reading, innovation);
  if (use == PressureUse::kGated) return use;
  filter_.update_pressure(height_m, delay_s, reading.noise_variance_m2);
  if (use == PressureUse::kStep) restart_forks();
  return use;
}

PressureUse HeightFilter::gate(const AltimeterReading& reading,
                               const VerticalFilter::Innovation& innovation) {
  if (squared(innovation.value) <= squared(config_.gate_sigma) * innovation.variance) {
    gated_ = false;
    has_used_ = true;
    last_used_m_ = innovation.value;
    last_height_m_ = reading.height_m;
    last_used_ns_ = reading.stamp_ns;
    return PressureUse::kUsed;
  }
  if (!gated_) {
    gated_ = true;
    gated_since_ns_ = reading.stamp_ns;
    first_gated_m_ = innovation.value;
    stepped_ = is_step(reading, innovation);
  }
  const double gated_s = seconds_between(gated_since_ns_, reading.stamp_ns);
  const double limit_s = ground_moves_ ? std::min(kRideGateS, config_.gate_time_s) : config_.gate_time_s;
  if (gated_s < limit_s) return PressureUse::kGated;
  gated_ = false;
  believe(innovation);
  return PressureUse::kStep;
}

bool HeightFilter::is_step(const AltimeterReading& reading,
                           const VerticalFilter::Innovation& innovation) const {
  const double since_s = std::max(0.0, seconds_between(last_used_ns_, reading.stamp_ns));
  const double noise_m = config_.gate_sigma * std::sqrt(2.0 * reading.noise_variance_m2);
  const double limit_m = std::max(kStepMinM, noise_m) + kUnfeltSpeed * since_s;
  // Both: a shock to the accelerometer moves the prediction, a fast lift the pressure; neither is a step.
  return has_used_ && std::abs(innovation.value - last_used_m_) > limit_m &&
         std::abs(reading.height_m - last_height_m_) > limit_m;
}

void HeightFilter::believe(const VerticalFilter::Innovation& innovation) {
  const double moved_m = innovation.value - first_gated_m_;
  filter_.inflate(stepped_ ? VerticalFilter::kOffset : VerticalFilter::kZ, squared(innovation.value));
  const bool ramp = std::abs(moved_m) > std::max(kRampMinM, kRampShare * std::abs(innovation.value)) &&
                    moved_m * innovation.value > 0.0;
  if (!ramp) return;
  filter_.inflate(VerticalFilter::kVz, squared(moved_m / std::max(config_.gate_time_s, 1.0)));
  ground_moves_ = true;
  agreeing_s_ = 0.0;
}

}  // namespace isobar
