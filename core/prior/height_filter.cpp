// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/height_filter.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Vertical speed without wheels and pressure: 1 sigma and correlation time.
constexpr double kBoundedSpeedMS = 0.3;
constexpr double kBoundedSpeedTimeS = 2.0;
// Vertical speed of an unobserved ride during a gap, 1 sigma.
constexpr double kRideSpeedMS = 0.7;
// Longest gating in a ride: only pressure constrains the vertical speed then, and a door leaves an error of
// 0.3 m/s.
constexpr double kRideGateS = 1.0;
// Time after the last update by the wheels for which they still constrain the vertical speed.
constexpr double kHeldS = 0.5;

// Share of the weather's standard deviation added to the reported variance: the filter's own is too small,
// because the wheels' correlated errors hinder the separation of weather and climb.
constexpr double kWeatherDoubt = 0.5;
// Largest delay of a pressure that is compensated: that of a base station's sample.
constexpr double kMaxDelayS = 6.0;
// Limits between ramp and step: change of the innovation while gated, as a share of the innovation and in
// metres. A ramp exceeds both.
constexpr double kRampShare = 0.5;
constexpr double kRampMinM = 0.3;

// A-priori error of the predicted size of a step, 1 sigma: far above any true one.
constexpr double kOpenStepSigmaM = 30.0;
// A larger innovation is no door (over in one or two seconds), so that the wait for its end is shorter.
constexpr double kAbsurdM = 20.0;
constexpr double kAbsurdWaitS = 0.3;

}  // namespace

HeightFilter::HeightFilter(const HeightConfig& config)
    : config_(config),
      filter_(config),
      forks_(config),
      ground_(config),
      judge_(config.gate_sigma),
      slew_(config.slew_rate_m_s, config.slew_bound_m) {}

void HeightFilter::start(double z_m, double vz_sigma_m_s) {
  filter_.start(z_m, vz_sigma_m_s);
  restart_forks();
  ground_.restart();
  judge_.restart();
  slew_.restart();
  step_.close();
  alone_s_ = 0.0;
  faulty_ = false;
  started_ = true;
}

void HeightFilter::resume(const VerticalFilter::Continuation& from) {
  start(from.z_m, from.vz_sigma_m_s);
  filter_.resume(from);
  restart_forks();
  // Until wheels and pressure agree: a ride that began before shows no acceleration.
  if (from.may_ride) ground_.begin();
}

void HeightFilter::restart_forks() {
  forks_.restart(filter_);
  ground_.forks_restarted();
}

void HeightFilter::predict(double up_accel_m_s2, double dt_s, double accel_density) {
  slew_.advance(dt_s);
  since_climb_s_ += dt_s;
  alone_s_ += weather_moves_ ? dt_s : 0.0;
  const double density = std::max(accel_density, squared(config_.accel_noise_m_s_sqrt_s));
  filter_.predict(up_accel_m_s2, dt_s, density, weather_moves_);
  ground_.add_acceleration(up_accel_m_s2 - filter_.value(VerticalFilter::kAccelBias), dt_s);
  forks_.predict(filter_, up_accel_m_s2, dt_s, density, weather_moves_);
}

void HeightFilter::bridge(double dt_s) {
  filter_.inflate(VerticalFilter::kZ, squared(kRideSpeedMS * dt_s));
  filter_.inflate(VerticalFilter::kVz, squared(std::min(kRideSpeedMS, kRideSpeedMS * dt_s)));
  restart_forks();
  judge_.restart();
}

void HeightFilter::update_climb(double climb_m_s, double forward_m_s, double dt_s,
                                double attitude_variance_rad2) {
  // Correlated errors as white noise of the same density: 2 tau sigma^2.
  const double slope_variance = squared(config_.slope_error_rad) +
                                std::max(0.0, attitude_variance_rad2 - squared(config_.slope_sigma_rad));
  const double speed_variance =
      slope_variance * squared(forward_m_s) + squared(config_.slip_share * climb_m_s);
  const double density = 2.0 * config_.slope_error_correlation_s * slope_variance * squared(forward_m_s) +
                         2.0 * config_.slip_correlation_s * squared(config_.slip_share * climb_m_s) +
                         squared(config_.rest_speed_m_s_sqrt_s);
  since_climb_s_ = 0.0;
  using Event = MovingGround::Event;
  const Event event = ground_.add_climb({climb_m_s, forward_m_s, speed_variance, dt_s}, forks_, filter_);
  if (event == Event::kBegins) filter_ = forks_.older();
  if (event == Event::kForkWrong || event == Event::kEnds) restart_forks();
  if (!ground_.moves()) filter_.update_climb(climb_m_s, forward_m_s, density / dt_s);
}

void HeightFilter::update_bounded_speed(double dt_s) {
  filter_.update_climb(0.0, 0.0, squared(kBoundedSpeedMS) * std::max(1.0, 2.0 * kBoundedSpeedTimeS / dt_s));
}

double HeightFilter::variance_m2() const {
  const double weather_m2 =
      squared(config_.weather_rate_m_s * alone_s_) + squared(config_.weather_walk_m_sqrt_s) * alone_s_;
  return filter_.variance(VerticalFilter::kZ) + squared(slew_.rest_m()) + squared(kWeatherDoubt) * weather_m2;
}

void HeightFilter::handle_event(const AltimeterReading& reading) {
  weather_moves_ = reading.source != HeightSource::kDifferential;
  if (!weather_moves_) alone_s_ = 0.0;
  const auto apply = [&](VerticalFilter& filter) {
    if (reading.event == ReferenceEvent::kBaseLost) filter.release_weather();
    if (reading.event == ReferenceEvent::kBaseJoined) filter.fold_weather_into_offset();
    // The reading has jumped by minus the weather since the base station was lost.
    if (reading.event == ReferenceEvent::kBaseReturned) {
      filter.settle_weather(-reading.weather_shift_m, reading.noise_variance_m2);
    }
  };
  if (reading.event == ReferenceEvent::kBaseReturned || reading.event == ReferenceEvent::kBaseSwitched) {
    slew_.begin();
  }
  apply(filter_);
  forks_.apply(apply);
}

PressureUse HeightFilter::update_pressure(const AltimeterReading& reading, double lever_m,
                                          std::int64_t now_ns) {
  if (!started_) return PressureUse::kGated;
  const double before_m = filter_.value(VerticalFilter::kZ);
  handle_event(reading);
  const double delay_s = std::clamp(seconds_between(reading.stamp_ns, now_ns), 0.0, kMaxDelayS);
  const PressureUse use = use_pressure(reading, lever_m, delay_s);
  // Without wheels only the correction of the event itself is held back: all others are motion.
  const bool event =
      reading.event == ReferenceEvent::kBaseReturned || reading.event == ReferenceEvent::kBaseSwitched;
  const bool held = !ground_.moves() && since_climb_s_ < kHeldS;
  if (event || (slew_.open() && held)) slew_.hold_back(filter_.value(VerticalFilter::kZ) - before_m);
  return use;
}

PressureUse HeightFilter::use_pressure(const AltimeterReading& reading, double lever_m, double delay_s) {
  const DisturbanceJudge::Evidence evidence = evidence_of(reading, lever_m, delay_s);
  const DisturbanceJudge::Verdict verdict = judge_.judge(evidence);
  rolled_back_ = rolled_back_ && judge_.gated();
  faulty_ = std::abs(evidence.without_step.value) > kAbsurdM;
  using Verdict = DisturbanceJudge::Verdict;
  if (verdict == Verdict::kWait) {
    if (judge_.unfelt() && ground_.moves() && !rolled_back_) roll_back();
    return PressureUse::kGated;
  }
  if (verdict == Verdict::kStep) open_step(reading, evidence);
  if (verdict == Verdict::kReturned) {
    filter_.close_step();
    step_.close();
  }
  if (verdict == Verdict::kMotion) follow(evidence.innovation);
  filter_.update_pressure(step_.height_without_m(reading) - lever_m, delay_s, reading.noise_variance_m2);
  if (verdict == Verdict::kFits) {
    compare_fork(reading, lever_m, delay_s, evidence.innovation.value);
    return PressureUse::kUsed;
  }
  restart_forks();
  return verdict == Verdict::kReturned ? PressureUse::kUsed : PressureUse::kStep;
}

DisturbanceJudge::Evidence HeightFilter::evidence_of(const AltimeterReading& reading, double lever_m,
                                                     double delay_s) const {
  DisturbanceJudge::Evidence evidence;
  evidence.stamp_ns = reading.stamp_ns;
  evidence.height_m = step_.height_without_m(reading);
  evidence.noise_variance_m2 = reading.noise_variance_m2;
  evidence.innovation =
      filter_.pressure_innovation(evidence.height_m - lever_m, delay_s, reading.noise_variance_m2);
  evidence.step_open = filter_.step_open();
  evidence.without_step =
      filter_.innovation_without_step(reading.height_m - lever_m, delay_s, reading.noise_variance_m2);
  // The fork's is larger, being without the wheels: the error of the prediction may come from them.
  evidence.climb_sigma_m_s = std::sqrt(
      std::max(filter_.variance(VerticalFilter::kVz), forks_.older().variance(VerticalFilter::kVz)));
  evidence.wait_s = ground_.moves() ? std::min(kRideGateS, config_.gate_time_s) : config_.gate_time_s;
  if (std::abs(evidence.innovation.value) > kAbsurdM) {
    evidence.wait_s = std::min(kAbsurdWaitS, evidence.wait_s);
  }
  return evidence;
}

// The known part absorbs the step as predicted; the filter's step state starts with the remaining error.
void HeightFilter::open_step(const AltimeterReading& reading, const DisturbanceJudge::Evidence& evidence) {
  step_.open(reading, evidence.height_m - evidence.innovation.value);
  filter_.open_step(kOpenStepSigmaM);
}

void HeightFilter::compare_fork(const AltimeterReading& reading, double lever_m, double delay_s,
                                double innovation_m) {
  const double height_m = step_.height_without_m(reading) - lever_m;
  const auto of_fork = forks_.older().pressure_innovation(height_m, delay_s, reading.noise_variance_m2);
  ground_.add_pressure(of_fork.value, innovation_m);
}

// Rolls back to the older fork, which has used no pressure since it was split off, before the disturbance. In
// a ride only pressure constrains the vertical speed: an error from the first disturbed samples would
// persist.
void HeightFilter::roll_back() {
  filter_ = forks_.older();
  rolled_back_ = true;
}

void HeightFilter::follow(const VerticalFilter::Innovation& innovation) {
  filter_.inflate(VerticalFilter::kZ, squared(innovation.value));
  const double moved_m = judge_.moved_m();
  const bool ramp = std::abs(moved_m) > std::max(kRampMinM, kRampShare * std::abs(innovation.value)) &&
                    moved_m * innovation.value > 0.0;
  if (!ramp) return;
  filter_.inflate(VerticalFilter::kVz, squared(moved_m / std::max(config_.gate_time_s, 1.0)));
  ground_.begin();
}

}  // namespace isobar
