// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/map_height.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/halt.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// A longer step between priors is a gap in the acceleration.
constexpr double kGapS = 0.1;
// Gate of a reading, in standard deviations, and how long it stays shut: doors are over by then.
constexpr double kGateSigmas = 3.0;
constexpr double kGateS = 3.0;
// Mean innovation beyond which the altimeter drifts, and the time of the mean.
constexpr double kDriftM = 0.03;
constexpr double kDriftMemoryS = 4.0;
// Bias beyond any zone or door (8 Pa), and beyond what weather may do: a barometer is wrong.
constexpr double kFaultM = 0.75;
// Way over which a correction of the map's height is given to new ground, and its largest step.
constexpr double kCorrectionWayM = 5.0;
constexpr double kLargestStepM = 0.02;
// Length of a straight drive, over which a tilted map has one slope.
constexpr double kSlopeWayM = 25.0;
// Standard deviation of a drift in multiples of the one seen: a sound barometer hardly drifts, a failing one at any rate.
constexpr double kDriftDoubt = 5.0;
// Share of a step that stays: the next scan is laid onto ground that was mapped before the step.
constexpr double kStays = 0.05;

}  // namespace

MapHeight::Vector MapHeight::bias_row() const {
  Vector h = Vector::Zero();
  h[kBias] = h[kTurbulence] = 1.0;
  h[kAirflow] = speed_m2_s2_;
  return h;
}

double MapHeight::bias_sd_m() const {
  const Vector h = bias_row();
  return std::sqrt(std::max(0.0, h.dot(P_ * h)));
}

AltimeterState MapHeight::altimeter() const {
  AltimeterState out;
  out.bias_m = bias_m();
  out.bias_sd_m = bias_sd_m();
  out.innovation_m = innovation_m_;
  out.drifts = drift_.suspect();
  out.drift_m_s = drift_.rate_m_s();
  out.faulty = altimeter_faulty();
  out.airflow_s2_m = x_[kAirflow];
  out.airflow_sd_s2_m = std::sqrt(P_(kAirflow, kAirflow));
  return out;
}

void MapHeight::restart_clock() {
  keep_airflow();
  MapHeight fresh(config_);
  fresh.x_ = x_;
  fresh.P_ = P_;
  *this = fresh;
}

void MapHeight::keep_airflow() {
  const double airflow = x_[kAirflow];
  const double variance = P_(kAirflow, kAirflow);
  x_.setZero();
  P_.setZero();
  x_[kAirflow] = airflow;
  P_(kAirflow, kAirflow) = variance;
}

void MapHeight::follow_map(double up_m) {
  x_[kBias] -= up_m;
  floor_bias_m_ -= up_m;
}

void MapHeight::restart() {
  keep_airflow();
  P_(kBias, kBias) = squared(config_.start_bias_sigma_m);
  P_(kRate, kRate) = squared(config_.drift_sigma_m_s);
  with_start_ = P_;
  slope_begun_ = zero_known_ = faulty_ = unseen_start_ = false;
  mean_innovation_m_ = 0.0;
  drift_.restart();
  base_sum_m_ = speed_sum_ = way_m_ = floor_bias_m_ = 0.0;
  sum_m_ = count_ = outside_s_ = unconfirmed_m2_ = risen_m_ = taken_m_ = 0.0;
  ride_.end();
}

void MapHeight::advance_to(std::int64_t stamp_ns, const PriorHistory& history) {
  std::size_t first = history.size();
  while (first > 0 && (!any_ || history[first - 1].stamp_ns > last_.stamp_ns)) --first;
  for (std::size_t i = first; i < history.size() && history[i].stamp_ns <= stamp_ns; ++i) take(history[i]);
}

void MapHeight::take(const Prior& prior) {
  const double dt_s = any_ ? seconds_between(last_.stamp_ns, prior.stamp_ns) : 0.0;
  if (any_ && prior.altimeter_count != last_.altimeter_count) take_reading(prior);
  if (!any_) shift_m_ = prior.altimeter_shift_m;
  // A robot that drives is on stairs, not in an elevator.
  const bool stands = wheels_stand(prior);
  if (dt_s > kGapS) {
    ride_.forget(dt_s);
  } else {
    ride_.add_acceleration(prior.up_accel_m_s2, dt_s, stands);
  }
  watch_ride(prior, stands);
  last_ = prior;
  any_ = true;
}

void MapHeight::take_reading(const Prior& prior) {
  ride_.add_altimeter(prior.altimeter_m, prior.altimeter_variance_m2);
  x_[kBias] += prior.altimeter_shift_m - shift_m_;
  shift_m_ = prior.altimeter_shift_m;
  sum_m_ += prior.altimeter_m;
  base_sum_m_ += prior.base_air_m;
  speed_sum_ += prior.v_base_m_s.squaredNorm();
  count_ += 1.0;
  noise_m2_ = prior.altimeter_variance_m2;
}

void MapHeight::widen(State state, double variance) {
  P_(state, state) += variance;
  with_start_(state, state) += variance;
}

// State and covariances over a step of time and way: x <- F x, P <- F P F^T + Q.
void MapHeight::predict(double dt_s, double moved_m, const MapTilt& tilt) {
  if (!slope_begun_) with_start_(kSlope, kSlope) = tilt.square_rad2;
  slope_begun_ = true;
  const bool base = last_.height_source == HeightSource::kDifferential;
  const double keep_bias = base ? std::exp(-dt_s / config_.bias_time_s) : 1.0;
  const double keep_rate = std::exp(-dt_s / config_.drift_time_s);
  const double keep_turbulence = std::exp(-dt_s / config_.turbulence_time_s);
  const double keep_slope = std::exp(-moved_m / kSlopeWayM);
  Matrix F = Matrix::Identity();
  F.diagonal() << 1.0, keep_bias, keep_turbulence, keep_slope, keep_rate, 1.0;
  F(kMap, kSlope) = moved_m;
  F(kBias, kRate) = dt_s;
  x_[kBias] -= floor_bias_m_;
  x_ = (F * x_).eval();
  x_[kBias] += floor_bias_m_;
  predict(F, tilt.variance_rad2, P_);
  predict(F, tilt.square_rad2, with_start_);
  widen(kMap, squared(config_.map_walk_m_sqrt_m) * moved_m);
  widen(kBias, base ? squared(config_.bias_sigma_m) * (1.0 - squared(keep_bias))
                    : squared(config_.weather_walk_m_sqrt_s) * dt_s);
  widen(kTurbulence, squared(config_.turbulence_sigma_m) * (1.0 - squared(keep_turbulence)));
  widen(kAirflow, squared(config_.airflow_walk_s2_m_sqrt_s) * dt_s);
  widen(kRate,
        (squared(config_.drift_sigma_m_s) + squared(kDriftDoubt * x_[kRate])) * (1.0 - squared(keep_rate)));
}

void MapHeight::predict(const Matrix& F, double tilt_rad2, Matrix& P) {
  P = (F * P * F.transpose()).eval();
  P(kSlope, kSlope) += tilt_rad2 * (1.0 - squared(F(kSlope, kSlope)));
}

double MapHeight::update(double z_m, double moved_m, double z_variance_m2, bool registered,
                         const MapTilt& tilt) {
  const double dt_s = updated_ns_ == 0 ? 0.0 : std::max(0.0, seconds_between(updated_ns_, last_.stamp_ns));
  updated_ns_ = last_.stamp_ns;
  predict(std::min(dt_s, 60.0), moved_m, tilt);
  if (!registered) widen(kMap, z_variance_m2);
  if (registered) unconfirmed_m2_ = 0.0;
  way_m_ += moved_m;
  measure_speed(moved_m, dt_s);
  if (riding()) drift_.restart();
  if (!riding() && count_ > 0.0) measure(z_m, dt_s);
  sum_m_ = count_ = base_sum_m_ = speed_sum_ = 0.0;
  if (!registered) return 0.0;
  const double share = std::min(1.0, moved_m / kCorrectionWayM);
  const double step_m = std::clamp(-x_[kMap] * share, -kLargestStepM, kLargestStepM);
  x_[kMap] += kStays * step_m;
  return step_m;
}

// Mean square of the speed over the readings; without wheels by the scans.
void MapHeight::measure_speed(double moved_m, double dt_s) {
  if (!last_.velocity_valid) {
    if (dt_s > 0.0) speed_m2_s2_ = squared(moved_m / dt_s);
  } else if (count_ > 0.0) {
    speed_m2_s2_ = speed_sum_ / count_;
  }
}

void MapHeight::watch_drift(double residual_m) {
  drift_.add({.stamp_ns = last_.stamp_ns,
              .residual_m = residual_m,
              .base_m = base_sum_m_ / count_,
              .way_m = way_m_,
              .airflow_sd_m = std::sqrt(P_(kAirflow, kAirflow)) * speed_m2_s2_,
              .base = last_.height_source == HeightSource::kDifferential});
  way_m_ = 0.0;
}

// Zero of the altimeter. That of a robot that drives contains the airflow, which its bias then lacks: b = -k v^2.
void MapHeight::begin_at(double difference_m) {
  zero_m_ = difference_m;
  zero_known_ = true;
  Matrix F = Matrix::Identity();
  F(kBias, kAirflow) = -speed_m2_s2_;
  x_ = (F * x_).eval();
  for (Matrix* P : {&P_, &with_start_}) *P = (F * *P * F.transpose()).eval();
}

void MapHeight::measure(double z_m, double dt_s) {
  const double reading_m = sum_m_ / count_;
  if (!zero_known_) begin_at(reading_m - z_m);
  // What the map's height is known to err by is not the altimeter's, and airflow is no drift.
  watch_drift(reading_m - zero_m_ - (z_m - x_[kMap]) - shift_m_ - x_[kAirflow] * speed_m2_s2_);
  Vector h = bias_row();
  h[kMap] = -1.0;
  const double noise_m2 = noise_m2_ / count_;
  const double variance = h.dot(P_ * h) + noise_m2;
  innovation_m_ = reading_m - zero_m_ - z_m - h.dot(x_);
  if (std::abs(innovation_m_) > kGateSigmas * std::sqrt(variance)) {
    outside_s_ += dt_s;
    if (outside_s_ < kGateS) return;
    // No door: another zone, weather, a drift. The altimeter's error, not the map's.
    x_[kBias] += innovation_m_;
    widen(kBias, squared(config_.bias_sigma_m));
    outside_s_ = 0.0;
    judge_fault();
    return;
  }
  outside_s_ = 0.0;
  use_innovation(h, variance, noise_m2, dt_s);
  judge_fault();
}

// What a drift has been taken for - an error or a slope of the map - is withdrawn when it is seen to be one.
void MapHeight::judge_fault() {
  faulty_ = std::abs(x_[kBias] - floor_bias_m_) > kFaultM;
  if (!altimeter_faulty()) return;
  widen(kMap, squared(x_[kMap]));
  widen(kSlope, squared(x_[kSlope]));
  x_[kMap] = x_[kSlope] = 0.0;
}

void MapHeight::use_innovation(const Vector& h, double variance, double noise_m2, double dt_s) {
  Vector K = P_ * h / variance;
  // Schmidt-Kalman: zero gain on the map. Innovations of one sign are a drift of the altimeter, which b follows late.
  mean_innovation_m_ += (innovation_m_ - mean_innovation_m_) * std::min(1.0, dt_s / kDriftMemoryS);
  if (altimeter_faulty() || std::abs(mean_innovation_m_) > kDriftM) K[kMap] = K[kSlope] = 0.0;
  if (drift_.suspect() != DriftSuspect::kNone) K[kAirflow] = 0.0;
  x_ += K * innovation_m_;
  x_[kAirflow] = std::clamp(x_[kAirflow], -kLargestAirflowS2M, kLargestAirflowS2M);
  const Matrix keep = Matrix::Identity() - K * h.transpose();
  for (Matrix* P : {&P_, &with_start_}) {
    *P = (keep * *P * keep.transpose() + noise_m2 * K * K.transpose()).eval();
    *P = (0.5 * (*P + P->transpose())).eval();
  }
}

}  // namespace isobar
