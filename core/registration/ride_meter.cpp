// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/ride_meter.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Longest time from the start of a ride to its recognition: the life of a fork of HeightFilter, and its delay.
constexpr std::size_t kRecognitionBins = 70;  // 3.5 s
// Length of the rest before it over which the altimeter is averaged, and the shortest that says anything of the bias.
constexpr std::size_t kRestBins = 60;       // 3 s
constexpr std::size_t kLeastRestBins = 10;  // 0.5 s
// Onset of a ride: mean acceleration over a window against the rest's, with its noise; and what a soft start gains
// before it shows.
constexpr std::size_t kWindowBins = 6;  // 0.3 s
constexpr double kOnsetMS2 = 0.02;
constexpr double kOnsetSigmas = 3.0;
constexpr std::size_t kSoftStartBins = 8;  // 0.4 s
// Least noise of the acceleration [m/s^2/sqrt(Hz)], the correlation time of vibration, and the memory of the estimate.
constexpr double kLeastAccelNoise = 0.0015;
constexpr double kVibrationS = 0.005;
constexpr double kNoiseMemoryS = 0.5;
// Scale of the accelerometer after its maker's calibration.
constexpr double kAccelScale = 1e-3;
// Vertical acceleration during a gap.
constexpr double kUnseenAccelMS2 = 1.0;
// Vertical speed of a floor or of a cabin that stands, and the standard deviations from it that are a ride.
constexpr double kStopSpeedMS = 0.003;
constexpr double kStopSigmas = 4.0;
// A stop lasts, and changes no speed.
constexpr std::size_t kStopBins = 16;  // 0.8 s
constexpr double kStopChangeMS = 0.02;
// Pressure in a ride: turbulence at its start, the way to another zone (0.2 m in 15 s), and the piston effect: some Pa
// at 1 m/s.
constexpr double kPressureStartM = 0.04;
constexpr double kPressureWalkMSqrtS = 0.05;
constexpr double kPistonS = 0.15;
// Temperature of the air: 3 K; a base outdoors makes 5 sigma. And by how much it differs from ride to ride.
constexpr double kAirScale = 0.01;
constexpr double kAirScaleWalk = 0.003;

// White noise of the same density [m^2/s^3] as the variance within an interval, from the integral of the acceleration and
// of its square.
double density_of(double speed_m_s, double square_m2_s3, double dt_s, double samples) {
  if (samples < 2.0) return 0.0;
  const double mean = speed_m_s / dt_s;
  const double variance = std::max(0.0, square_m2_s3 / dt_s - mean * mean);
  return variance * std::max(dt_s / samples, kVibrationS);
}

}  // namespace

void RideMeter::forget(double gap_s) {
  rest_.advance(gap_s);
  count_ = 0;
  if (riding_) use_open();
  open_ = Bin{};
  if (!riding_) return;
  Bin gap;
  gap.dt_s = gap_s;
  gap.speed_m_s = x_[kAccelBias] * gap_s;
  predict(gap);
  P_(kSpeed, kSpeed) += squared(kUnseenAccelMS2 * gap_s);
  P_(kRisen, kRisen) += squared(0.5 * kUnseenAccelMS2 * gap_s * gap_s);
}

void RideMeter::add_acceleration(double up_accel_m_s2, double dt_s, bool stands) {
  open_.dt_s += dt_s;
  open_.speed_m_s += up_accel_m_s2 * dt_s;
  open_.square_m2_s3 += up_accel_m_s2 * up_accel_m_s2 * dt_s;
  open_.samples += 1.0;
  open_.stands = open_.stands && stands && !riding_;
  if (open_.dt_s < kBinS) return;
  learn_noise(open_);
  keep(open_);
  if (riding_) use(open_);
  open_ = Bin{};
}

// A bin too old for the ride that may be recognised next is a rest.
void RideMeter::keep(const Bin& bin) {
  newest_ = (newest_ + 1) % kBins;
  bins_[newest_] = bin;
  count_ = std::min(count_ + 1, kBins);
  if (count_ > kRecognitionBins) take_rest(back(kRecognitionBins));
}

void RideMeter::take_rest(const Bin& bin) {
  if (bin.stands) {
    rest_.add(bin.speed_m_s / bin.dt_s, bin.dt_s, density_);
  } else {
    rest_.advance(bin.dt_s);
  }
}

void RideMeter::add_altimeter(double height_m, double variance_m2) {
  const double weight = 1.0 / std::max(variance_m2, 1e-8);
  open_.altimeter_m =
      (open_.altimeter_m * open_.altimeter_weight + height_m * weight) / (open_.altimeter_weight + weight);
  open_.altimeter_weight += weight;
}

// Bins back to the last motion of the wheels.
std::size_t RideMeter::rest_bins() const {
  std::size_t age = 0;
  while (age < count_ && back(age).stands) ++age;
  return age;
}

// Speed gained over `bins` bins from `age` back.
double RideMeter::gained_m_s(std::size_t age, std::size_t bins, double bias_m_s2) const {
  double speed_m_s = 0.0;
  for (std::size_t i = age; i < age + bins; ++i) speed_m_s += back(i).speed_m_s - bias_m_s2 * back(i).dt_s;
  return speed_m_s;
}

// Bins back to the start of the ride. `rest`: bins back to the start of the rest in which it began.
std::size_t RideMeter::bins_of_ride(std::size_t rest) const {
  double bias = rest_.mean_m_s2();
  double variance = rest_.variance();
  const double density = density_ + squared(RestAcceleration::kDisturbedSqrtS);
  if (!rest_.known()) {
    if (rest < kLeastRestBins) return rest;
    bias = gained_m_s(rest - kLeastRestBins, kLeastRestBins, 0.0) / (kLeastRestBins * kBinS);
    variance = density / (kLeastRestBins * kBinS);
  }
  const double window_s = kWindowBins * kBinS;
  const double limit_m_s2 = kOnsetMS2 + kOnsetSigmas * std::sqrt(density / window_s + variance);
  std::size_t oldest = std::min(rest, kRecognitionBins);
  while (oldest > kWindowBins &&
         std::abs(gained_m_s(oldest - kWindowBins, kWindowBins, bias)) < limit_m_s2 * window_s) {
    --oldest;
  }
  return std::min(oldest + kSoftStartBins, rest);
}

// Zero of the altimeter: its mean over the rest before the ride.
void RideMeter::learn_zero(std::size_t ride_bins, std::size_t rest) {
  double weight = 0.0;
  double height = 0.0;
  for (std::size_t age = ride_bins; age < std::min(rest, ride_bins + kRestBins); ++age) {
    weight += back(age).altimeter_weight;
    height += back(age).altimeter_weight * back(age).altimeter_m;
  }
  zero_known_ = weight > 0.0;
  if (zero_known_) zero_m_ = height / weight;
}

bool RideMeter::remembers_start() const {
  const std::size_t rest = rest_bins();
  return count_ >= kRecognitionBins || rest >= bins_of_ride(rest) + kLeastRestBins;
}

void RideMeter::begin() {
  const double scale = x_[kScale];
  const double scale_variance = P_(kScale, kScale);
  x_.setZero();
  P_.setZero();
  const std::size_t rest = rest_bins();
  const std::size_t ride_bins = bins_of_ride(rest);
  for (std::size_t age = std::min(rest, kRecognitionBins); age-- > ride_bins;) take_rest(back(age));
  learn_zero(ride_bins, rest);
  x_[kAccelBias] = rest_.mean_m_s2();
  P_(kAccelBias, kAccelBias) = rest_.variance();
  x_[kScale] = scale;
  P_(kScale, kScale) = scale_variance > 0.0 ? scale_variance + squared(kAirScaleWalk) : squared(kAirScale);
  P_(kSpeed, kSpeed) = squared(kStopSpeedMS);
  P_(kPressure, kPressure) = squared(kPressureStartM);
  P_(kPiston, kPiston) = squared(kPistonS);
  riding_ = true;
  for (std::size_t age = ride_bins; age-- > 0;) use(back(age));
  // The memory is part of this ride, no rest before the next one.
  for (Bin& bin : bins_) bin.stands = false;
}

bool RideMeter::may_have_stopped() const {
  const std::size_t bins = std::min(count_, kStopBins);
  const double change_m_s = kStopChangeMS + kStopSigmas * std::sqrt(density_ * kStopBins * kBinS);
  return std::abs(gained_m_s(0, bins, x_[kAccelBias])) < change_m_s &&
         std::abs(x_[kSpeed]) < kStopSigmas * std::sqrt(P_(kSpeed, kSpeed) + squared(kStopSpeedMS));
}

void RideMeter::end() {
  if (!riding_) return;
  use_open();
  Vector h = Vector::Zero();
  h[kSpeed] = 1.0;
  update(h, 0.0, squared(kStopSpeedMS));
  riding_ = false;
}

double RideMeter::variance_m2() const { return P_(kRisen, kRisen) + squared(kAccelScale * x_[kRisen]); }

double RideMeter::air_scale_sd() const {
  return P_(kScale, kScale) > 0.0 ? std::sqrt(P_(kScale, kScale)) : kAirScale;
}

double RideMeter::risen_m() const {
  if (!riding_) return x_[kRisen];
  const double step_m_s = open_.speed_m_s - x_[kAccelBias] * open_.dt_s;
  return x_[kRisen] + open_.dt_s * (x_[kSpeed] + 0.5 * step_m_s);
}

// The interval under way, before it is full.
void RideMeter::use_open() {
  if (open_.dt_s > 0.0) use(open_);
  open_ = Bin{};
}

void RideMeter::use(const Bin& bin) {
  predict(bin);
  if (!(bin.altimeter_weight > 0.0)) return;
  if (!zero_known_) {
    zero_m_ = bin.altimeter_m - (1.0 + x_[kScale]) * x_[kRisen] - x_[kPressure];
    zero_known_ = true;
  }
  Vector h = Vector::Zero();
  h[kRisen] = 1.0 + x_[kScale];
  h[kScale] = x_[kRisen];
  h[kPressure] = 1.0;
  h[kPiston] = x_[kSpeed];
  h[kSpeed] = x_[kPiston];
  const double predicted_m = h[kRisen] * x_[kRisen] + x_[kPressure] + x_[kPiston] * x_[kSpeed];
  update(h, bin.altimeter_m - zero_m_ - predicted_m + h.dot(x_), 1.0 / bin.altimeter_weight);
}

void RideMeter::learn_noise(const Bin& bin) {
  const double gain = std::min(1.0, bin.dt_s / kNoiseMemoryS);
  density_ += (density_of(bin.speed_m_s, bin.square_m2_s3, bin.dt_s, bin.samples) - density_) * gain;
}

void RideMeter::predict(const Bin& bin) {
  const double dt_s = bin.dt_s;
  const double step_m_s = bin.speed_m_s - x_[kAccelBias] * dt_s;
  x_[kRisen] += dt_s * (x_[kSpeed] + 0.5 * step_m_s);
  x_[kSpeed] += step_m_s;
  Matrix F = Matrix::Identity();
  F(kRisen, kSpeed) = dt_s;
  F(kRisen, kAccelBias) = -0.5 * dt_s * dt_s;
  F(kSpeed, kAccelBias) = -dt_s;
  P_ = (F * P_ * F.transpose()).eval();
  // Vibration begins with the ride, before the mean knows it.
  const double density = std::max(density_, density_of(bin.speed_m_s, bin.square_m2_s3, dt_s, bin.samples));
  P_(kSpeed, kSpeed) += std::max(density, squared(kLeastAccelNoise)) * dt_s;
  P_(kAccelBias, kAccelBias) += squared(RestAcceleration::kWalkMS2SqrtS) * dt_s;
  P_(kPressure, kPressure) += squared(kPressureWalkMSqrtS) * dt_s;
}

void RideMeter::update(const Vector& h, double measured, double variance) {
  const Vector Ph = P_ * h;
  const Vector K = Ph / (h.dot(Ph) + variance);
  x_ += K * (measured - h.dot(x_));
  P_ -= K * Ph.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

}  // namespace isobar
