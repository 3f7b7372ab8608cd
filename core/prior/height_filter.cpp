// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/height_filter.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Lifetime of a fork. The two restart in turn, so that the age of the older one is always 50 … 100 % of it.
constexpr double kForkLifeS = 3.0;
// A younger fork is still too close to the filter to compare.
constexpr double kForkMinAgeS = 0.5;
// Wheels and fork must disagree for this long before the ground counts as moving: longer than a bump.
constexpr double kDisagreementS = 0.08;
// Largest excess of the fork's pressure innovation over the filter's in a ride, where the pressure fits the
// fork and not the wheels. A larger excess is the effect of vibration on the fork.
constexpr double kForkMisfitM = 0.15;

// End of a ride: low-pass of the vertical acceleration, and the value below which it counts as zero.
constexpr double kAccelSmoothingS = 0.3;
constexpr double kQuietAccelMS2 = 0.12;
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
// Lower bound of the pressure ratio after subtracting a fault: it stays positive.
constexpr double kLeastRatio = 0.05;

}  // namespace

HeightFilter::HeightFilter(const HeightConfig& config)
    : config_(config),
      filter_(config),
      forks_{Fork{VerticalFilter(config), 0.0}, Fork{VerticalFilter(config), 0.0}},
      judge_(config.gate_sigma),
      slew_(config.slew_rate_m_s, config.slew_bound_m) {}

void HeightFilter::start(double z_m, double vz_sigma_m_s) {
  filter_.start(z_m, vz_sigma_m_s);
  restart_forks();
  ground_moves_ = false;
  judge_.restart();
  slew_.restart();
  fault_share_ = alone_s_ = 0.0;
  faulty_ = false;
  started_ = true;
}

void HeightFilter::resume(const VerticalFilter::Continuation& from) {
  start(from.z_m, from.vz_sigma_m_s);
  filter_.resume(from);
  restart_forks();
  // Until wheels and pressure agree: a ride that began before shows no acceleration.
  ground_moves_ = from.may_ride;
  agreeing_s_ = 0.0;
}

void HeightFilter::restart_forks() {
  for (Fork& fork : forks_) fork = {filter_, 0.0};
  disagreeing_s_ = fork_misfit_m_ = 0.0;
}

void HeightFilter::predict(double up_accel_m_s2, double dt_s, double accel_density) {
  slew_.advance(dt_s);
  since_climb_s_ += dt_s;
  alone_s_ += weather_moves_ ? dt_s : 0.0;
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
  // The other one's age is set to half a lifetime at most, which staggers the two: one fork always predates a
  // ride.
  older = {filter_, 0.0};
  Fork& other = older_fork();
  other.age_s = std::min(other.age_s, 0.5 * kForkLifeS);
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
    if (fork_misfit_m_ > kForkMisfitM) {
      restart_forks();
      return;
    }
    filter_ = fork.filter;
    ground_moves_ = true;
    agreeing_s_ = 0.0;
    return;
  }
  const auto innovation = filter_.climb_innovation(climb_m_s, forward_m_s, speed_variance);
  const double limit = config_.ground_stopped_speed_m_s + 2.0 * std::sqrt(innovation.variance);
  const bool agree = std::abs(innovation.value) < limit && std::abs(accel_m_s2_) < kQuietAccelMS2;
  agreeing_s_ = agree ? agreeing_s_ + dt_s : 0.0;
  if (agreeing_s_ < config_.ground_stopped_time_s) return;
  ground_moves_ = false;
  restart_forks();
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
  for (Fork& fork : forks_) apply(fork.filter);
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
  const bool held = !ground_moves_ && since_climb_s_ < kHeldS;
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
    if (judge_.unfelt() && ground_moves_ && !rolled_back_) roll_back();
    return PressureUse::kGated;
  }
  if (verdict == Verdict::kStep) open_step(reading, evidence);
  if (verdict == Verdict::kReturned) close_step();
  if (verdict == Verdict::kMotion) follow(evidence.innovation);
  filter_.update_pressure(without_fault_m(reading) - lever_m, delay_s, reading.noise_variance_m2);
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
  evidence.height_m = without_fault_m(reading);
  evidence.noise_variance_m2 = reading.noise_variance_m2;
  evidence.innovation =
      filter_.pressure_innovation(evidence.height_m - lever_m, delay_s, reading.noise_variance_m2);
  evidence.step_open = filter_.step_open();
  evidence.without_step =
      filter_.innovation_without_step(reading.height_m - lever_m, delay_s, reading.noise_variance_m2);
  // The fork's is larger, being without the wheels: the error of the prediction may come from them.
  evidence.climb_sigma_m_s = std::sqrt(
      std::max(filter_.variance(VerticalFilter::kVz), older_fork().filter.variance(VerticalFilter::kVz)));
  evidence.wait_s = ground_moves_ ? std::min(kRideGateS, config_.gate_time_s) : config_.gate_time_s;
  if (std::abs(evidence.innovation.value) > kAbsurdM) {
    evidence.wait_s = std::min(kAbsurdWaitS, evidence.wait_s);
  }
  return evidence;
}

// Height with an open step subtracted. A step is an additive error of the pressure, so it is subtracted from
// the ratio of pressures: subtracted as a height, a large step would falsify the scale of later climbs.
double HeightFilter::without_fault_m(const AltimeterReading& reading) const {
  if (fault_share_ == 0.0) return reading.height_m;
  const double ratio = std::exp(-reading.height_m / reading.scale_m) - fault_share_;
  return -reading.scale_m * std::log(std::max(ratio, kLeastRatio));
}

void HeightFilter::open_step(const AltimeterReading& reading, const DisturbanceJudge::Evidence& evidence) {
  const double expected_m = evidence.height_m - evidence.innovation.value;
  fault_share_ = std::exp(-reading.height_m / reading.scale_m) - std::exp(-expected_m / reading.scale_m);
  // fault_share_ absorbs the step as predicted; the filter's step state starts with the remaining error.
  filter_.open_step(kOpenStepSigmaM);
}

void HeightFilter::close_step() {
  filter_.close_step();
  fault_share_ = 0.0;
}

void HeightFilter::compare_fork(const AltimeterReading& reading, double lever_m, double delay_s,
                                double innovation_m) {
  const double height_m = without_fault_m(reading) - lever_m;
  const auto of_fork = older_fork().filter.pressure_innovation(height_m, delay_s, reading.noise_variance_m2);
  fork_misfit_m_ = std::abs(of_fork.value) - std::abs(innovation_m);
}

// Rolls back to the older fork, which has used no pressure since it was split off, before the disturbance. In
// a ride only pressure constrains the vertical speed: an error from the first disturbed samples would
// persist.
void HeightFilter::roll_back() {
  filter_ = older_fork().filter;
  rolled_back_ = true;
}

void HeightFilter::follow(const VerticalFilter::Innovation& innovation) {
  filter_.inflate(VerticalFilter::kZ, squared(innovation.value));
  const double moved_m = judge_.moved_m();
  const bool ramp = std::abs(moved_m) > std::max(kRampMinM, kRampShare * std::abs(innovation.value)) &&
                    moved_m * innovation.value > 0.0;
  if (!ramp) return;
  filter_.inflate(VerticalFilter::kVz, squared(moved_m / std::max(config_.gate_time_s, 1.0)));
  ground_moves_ = true;
  agreeing_s_ = 0.0;
}

}  // namespace isobar
