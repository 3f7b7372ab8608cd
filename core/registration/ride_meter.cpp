// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/ride_meter.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Longest time from the start of a ride to its recognition: the life of a fork of HeightFilter, and its delay.
constexpr double kRecognitionS = 3.5;
// Length of the rest before it over which the acceleration is averaged, and below which it says nothing.
constexpr double kRestS = 3.0;
constexpr double kLeastRestS = 0.5;
// Least noise of the acceleration [m/s^2/sqrt(Hz)], the correlation time of vibration, and the memory of the estimate.
constexpr double kLeastAccelNoise = 0.003;
constexpr double kVibrationS = 0.005;
constexpr double kNoiseMemoryS = 2.0;
// Bias of the vertical acceleration without a rest to learn it from, and its walk over a ride.
constexpr double kUnknownBiasMS2 = 0.05;
constexpr double kBiasWalkMS2SqrtS = 2e-4;
// Mean over a rest: slow vibration and people who step in.
constexpr double kRestBiasSqrtS = 0.006;
// Vertical speed of a floor or of a cabin that stands.
constexpr double kStopSpeedMS = 0.003;
// Pressure in a ride: turbulence at its start, the way to another zone (0.2 m in 15 s), and the piston effect: some Pa
// at 1 m/s.
constexpr double kPressureStartM = 0.04;
constexpr double kPressureWalkMSqrtS = 0.05;
constexpr double kPistonS = 0.15;

}  // namespace

void RideMeter::forget() {
  open_ = Bin{};
  count_ = 0;
}

void RideMeter::add_acceleration(double up_accel_m_s2, double dt_s, bool stands) {
  open_.dt_s += dt_s;
  open_.speed_m_s += up_accel_m_s2 * dt_s;
  open_.square_m2_s3 += up_accel_m_s2 * up_accel_m_s2 * dt_s;
  open_.samples += 1.0;
  open_.stands = open_.stands && stands;
  if (open_.dt_s < kBinS) return;
  learn_noise(open_);
  newest_ = (newest_ + 1) % kBins;
  bins_[newest_] = open_;
  count_ = std::min(count_ + 1, kBins);
  if (riding_) use(open_);
  open_ = Bin{};
}

void RideMeter::add_altimeter(double height_m, double variance_m2) {
  const double weight = 1.0 / std::max(variance_m2, 1e-8);
  open_.altimeter_m =
      (open_.altimeter_m * open_.altimeter_weight + height_m * weight) / (open_.altimeter_weight + weight);
  open_.altimeter_weight += weight;
}

// Bins back to the latest possible start of the ride: as far as a recognition may take, not past the stop.
std::size_t RideMeter::bins_of_ride() const {
  std::size_t age = 0;
  double elapsed_s = 0.0;
  while (age < count_ && back(age).stands && elapsed_s < kRecognitionS) elapsed_s += back(age++).dt_s;
  return age;
}

// Bias of the acceleration and zero of the altimeter from the rest before the ride.
void RideMeter::learn_rest(std::size_t ride_bins) {
  double elapsed_s = 0.0;
  double speed_m_s = 0.0;
  double weight = 0.0;
  double height = 0.0;
  for (std::size_t age = ride_bins; age < count_ && back(age).stands && elapsed_s < kRestS; ++age) {
    elapsed_s += back(age).dt_s;
    speed_m_s += back(age).speed_m_s;
    weight += back(age).altimeter_weight;
    height += back(age).altimeter_weight * back(age).altimeter_m;
  }
  P_(kAccelBias, kAccelBias) = squared(kUnknownBiasMS2);
  if (elapsed_s >= kLeastRestS) {
    x_[kAccelBias] = speed_m_s / elapsed_s;
    P_(kAccelBias, kAccelBias) = (squared(kRestBiasSqrtS) + density_) / elapsed_s;
  }
  zero_known_ = weight > 0.0;
  if (zero_known_) zero_m_ = height / weight;
}

bool RideMeter::remembers_start() const { return static_cast<double>(count_) * kBinS >= kRecognitionS; }

void RideMeter::begin() {
  x_.setZero();
  P_.setZero();
  const std::size_t ride_bins = bins_of_ride();
  learn_rest(ride_bins);
  P_(kSpeed, kSpeed) = squared(kStopSpeedMS);
  P_(kPressure, kPressure) = squared(kPressureStartM);
  P_(kPiston, kPiston) = squared(kPistonS);
  riding_ = true;
  for (std::size_t age = ride_bins; age-- > 0;) use(back(age));
}

void RideMeter::end() {
  if (!riding_) return;
  Vector h = Vector::Zero();
  h[kSpeed] = 1.0;
  update(h, 0.0, squared(kStopSpeedMS));
  riding_ = false;
}

void RideMeter::use(const Bin& bin) {
  predict(bin);
  if (!(bin.altimeter_weight > 0.0)) return;
  if (!zero_known_) {
    zero_m_ = bin.altimeter_m - x_[kRisen] - x_[kPressure];
    zero_known_ = true;
  }
  Vector h = Vector::Zero();
  h[kRisen] = h[kPressure] = 1.0;
  h[kPiston] = x_[kSpeed];
  h[kSpeed] = x_[kPiston];
  const double predicted_m = x_[kRisen] + x_[kPressure] + x_[kPiston] * x_[kSpeed];
  update(h, bin.altimeter_m - zero_m_ - predicted_m + h.dot(x_), 1.0 / bin.altimeter_weight);
}

// White noise of the same density as the variance within the intervals.
void RideMeter::learn_noise(const Bin& bin) {
  const double mean = bin.speed_m_s / bin.dt_s;
  const double variance = std::max(0.0, bin.square_m2_s3 / bin.dt_s - mean * mean);
  const double density = variance * std::max(bin.dt_s / bin.samples, kVibrationS);
  density_ += (density - density_) * std::min(1.0, bin.dt_s / kNoiseMemoryS);
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
  P_(kSpeed, kSpeed) += std::max(density_, squared(kLeastAccelNoise)) * dt_s;
  P_(kAccelBias, kAccelBias) += squared(kBiasWalkMS2SqrtS) * dt_s;
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
