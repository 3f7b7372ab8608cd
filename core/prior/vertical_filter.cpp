// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/vertical_filter.hpp"

#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Offset between two barometers before the first sample, 1 sigma: DPS310 differ by up to 100 Pa, 8 m.
constexpr double kOffsetSigmaM = 10.0;
// Height at the start, 1 sigma: exact by definition, but not singular.
constexpr double kStartSigmaM = 1e-3;

}  // namespace

VerticalFilter::VerticalFilter(const HeightConfig& config) : config_(config) {}

void VerticalFilter::start(double z_m, double vz_sigma_m_s) {
  x_.setZero();
  x_[kZ] = z_m;
  P_.setZero();
  P_(kZ, kZ) = squared(kStartSigmaM);
  P_(kVz, kVz) = squared(vz_sigma_m_s);
  P_(kAccelBias, kAccelBias) = squared(config_.accel_bias_sigma_m_s2);
  P_(kSlope, kSlope) = squared(config_.slope_sigma_rad);
  P_(kOffset, kOffset) = squared(kOffsetSigmaM);
  P_(kTurbulence, kTurbulence) = squared(config_.turbulence_sigma_m);
  P_(kWeatherRate, kWeatherRate) = squared(config_.weather_rate_m_s);
  step_open_ = false;
}

void VerticalFilter::resume(const Continuation& from) {
  start(from.z_m, from.vz_sigma_m_s);
  P_(kZ, kZ) = from.variance_m2;
  x_[kVz] = from.vz_m_s;
  x_[kOffset] = from.offset_m;
  P_(kOffset, kOffset) = 0.0;
  offset_age_s_ = config_.offset_learning_s;
}

void VerticalFilter::predict(double up_accel_m_s2, double dt_s, double accel_density, bool weather_moves) {
  const double accel = up_accel_m_s2 - x_[kAccelBias];
  const double keep = std::exp(-dt_s / config_.turbulence_time_s);
  x_[kZ] += dt_s * (x_[kVz] + 0.5 * dt_s * accel);
  x_[kVz] += dt_s * accel;
  x_[kTurbulence] *= keep;

  // F differs from the identity in z <- vz, z <- b_a, vz <- b_a and the decay of n: P = F P F^T row by row.
  const double half_square = 0.5 * dt_s * dt_s;
  P_.row(kZ) += dt_s * P_.row(kVz) - half_square * P_.row(kAccelBias);
  P_.row(kVz) -= dt_s * P_.row(kAccelBias);
  P_.row(kTurbulence) *= keep;
  P_.col(kZ) += dt_s * P_.col(kVz) - half_square * P_.col(kAccelBias);
  P_.col(kVz) -= dt_s * P_.col(kAccelBias);
  P_.col(kTurbulence) *= keep;

  P_(kZ, kZ) += accel_density * dt_s * dt_s * dt_s / 3.0;
  P_(kZ, kVz) += accel_density * half_square;
  P_(kVz, kZ) += accel_density * half_square;
  P_(kVz, kVz) += accel_density * dt_s;
  P_(kAccelBias, kAccelBias) += squared(config_.accel_bias_walk_m_s2_sqrt_s) * dt_s;
  P_(kSlope, kSlope) += squared(config_.slope_walk_rad_sqrt_s) * dt_s;
  P_(kTurbulence, kTurbulence) += squared(config_.turbulence_sigma_m) * (1.0 - keep * keep);
  if (offset_age_s_ >= 0.0) age_offset(dt_s);
  if (weather_moves) drift_weather(dt_s);
}

void VerticalFilter::drift_weather(double dt_s) {
  x_[kWeather] += dt_s * x_[kWeatherRate];
  P_.row(kWeather) += dt_s * P_.row(kWeatherRate);
  P_.col(kWeather) += dt_s * P_.col(kWeatherRate);
  P_(kWeather, kWeather) += squared(config_.weather_walk_m_sqrt_s) * dt_s;
  // First-order Gauss-Markov process of the rate: fronts pass.
  const double keep = std::exp(-dt_s / kWeatherRateTimeS);
  x_[kWeatherRate] *= keep;
  P_.row(kWeatherRate) *= keep;
  P_.col(kWeatherRate) *= keep;
  P_(kWeatherRate, kWeatherRate) += squared(config_.weather_rate_m_s) * (1.0 - keep * keep);
}

void VerticalFilter::age_offset(double dt_s) {
  if (offset_age_s_ >= config_.offset_learning_s) return;
  offset_age_s_ += dt_s;
  if (offset_age_s_ < config_.offset_learning_s) return;
  // From here on the offset is fixed and its error becomes one of the height: z + (b_p - its estimate).
  P_.row(kZ) += P_.row(kOffset);
  P_.col(kZ) += P_.col(kOffset);
  P_.row(kOffset).setZero();
  P_.col(kOffset).setZero();
}

VerticalFilter::Vector VerticalFilter::pressure_row(double delay_s) const {
  Vector h = Vector::Zero();
  h[kZ] = h[kOffset] = h[kTurbulence] = h[kWeather] = h[kStep] = 1.0;
  h[kVz] = -delay_s;
  return h;
}

VerticalFilter::Vector VerticalFilter::climb_row(double forward_m_s) const {
  Vector h = Vector::Zero();
  h[kVz] = 1.0;
  h[kSlope] = -forward_m_s;
  return h;
}

VerticalFilter::Innovation VerticalFilter::innovation(const Vector& h, double measured,
                                                      double variance) const {
  return {measured - h.dot(x_), h.dot(P_ * h) + variance};
}

VerticalFilter::Innovation VerticalFilter::pressure_innovation(double height_m, double delay_s,
                                                               double variance_m2) const {
  return innovation(pressure_row(delay_s), height_m, variance_m2);
}

VerticalFilter::Innovation VerticalFilter::innovation_without_step(double height_m, double delay_s,
                                                                   double variance_m2) const {
  Vector h = pressure_row(delay_s);
  h[kStep] = 0.0;
  return innovation(h, height_m, variance_m2);
}

void VerticalFilter::update_pressure(double height_m, double delay_s, double variance_m2) {
  update(pressure_row(delay_s), height_m, variance_m2);
  if (offset_age_s_ < 0.0) offset_age_s_ = 0.0;
}

VerticalFilter::Innovation VerticalFilter::climb_innovation(double climb_m_s, double forward_m_s,
                                                            double variance) const {
  return innovation(climb_row(forward_m_s), climb_m_s, variance);
}

void VerticalFilter::update_climb(double climb_m_s, double forward_m_s, double variance) {
  update(climb_row(forward_m_s), climb_m_s, variance);
}

void VerticalFilter::forget(State state) {
  x_[state] = 0.0;
  P_.row(state).setZero();
  P_.col(state).setZero();
}

double VerticalFilter::pressure_bias_m() const {
  return x_[kOffset] + x_[kTurbulence] + x_[kWeather] + x_[kStep];
}

double VerticalFilter::pressure_bias_variance_m2() const {
  Vector row = Vector::Zero();
  row[kOffset] = row[kTurbulence] = row[kWeather] = row[kStep] = 1.0;
  return row.dot(P_ * row);
}

void VerticalFilter::release_weather() {
  forget(kWeatherRate);
  P_(kWeatherRate, kWeatherRate) = squared(config_.weather_rate_m_s);
}

// Schmidt-Kalman: zero gain on vz, bias, slope, about which minutes of weather carry no information; Joseph
// form stays valid for any gain.
void VerticalFilter::settle_weather(double weather_m, double variance_m2) {
  Vector h = Vector::Zero();
  h[kWeather] = 1.0;
  const double S = P_(kWeather, kWeather) + variance_m2;
  Vector K = P_.col(kWeather) / S;
  K[kVz] = K[kAccelBias] = K[kSlope] = 0.0;
  x_ += K * (weather_m - x_[kWeather]);
  const Matrix keep = Matrix::Identity() - K * h.transpose();
  P_ = (keep * P_ * keep.transpose() + variance_m2 * K * K.transpose()).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  forget(kWeather);
}

void VerticalFilter::fold_weather_into_offset() {
  x_[kOffset] += x_[kWeather];
  P_.row(kOffset) += P_.row(kWeather);
  P_.col(kOffset) += P_.col(kWeather);
  forget(kWeather);
}

void VerticalFilter::open_step(double sigma_m) {
  forget(kStep);
  P_(kStep, kStep) = squared(sigma_m);
  step_open_ = true;
}

void VerticalFilter::close_step() {
  forget(kStep);
  step_open_ = false;
}

void VerticalFilter::update(const Vector& h, double measured, double variance) {
  const Vector Ph = P_ * h;
  const double S = h.dot(Ph) + variance;
  const Vector K = Ph / S;
  x_ += K * (measured - h.dot(x_));
  P_.noalias() -= K * Ph.transpose();
  // Rounding errors: restore the symmetry, clamp the variances at zero.
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  P_.diagonal() = P_.diagonal().cwiseMax(0.0);
}

}  // namespace isobar
