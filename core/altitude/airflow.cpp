// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/airflow.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Residual beyond which a height is left out, in standard deviations: a door or a zone.
constexpr double kAirflowGateSigmas = 4.0;
// Longest step: after a pause b is as unknown as ever anyway.
constexpr double kLongestAgingS = 600.0;

}  // namespace

AirflowEstimator::AirflowEstimator(const Options& options)
    : options_(options),
      P_(Eigen::Vector2d(squared(options.bias_sigma_m), squared(options.coefficient_sigma)).asDiagonal()) {}

void AirflowEstimator::add(double dt_s, double speed_m_s, double residual_m, double variance_m2) {
  if (!std::isfinite(residual_m) || !std::isfinite(speed_m_s) || !(dt_s >= 0.0)) return;
  const double keep = std::exp(-std::min(dt_s, kLongestAgingS) / options_.bias_time_s);
  x_[0] *= keep;
  P_(0, 0) = squared(keep) * P_(0, 0) + (1.0 - squared(keep)) * squared(options_.bias_sigma_m);
  P_(0, 1) *= keep;
  P_(1, 0) *= keep;
  // Turbulence is correlated: the variance of white noise of the same density.
  const double white = std::max(1.0, 2.0 * options_.turbulence_time_s / std::max(dt_s, 1e-3));
  const double variance = variance_m2 + squared(options_.turbulence_sigma_m) * white;
  const Eigen::Vector2d h(1.0, squared(speed_m_s));
  const Eigen::Vector2d Ph = P_ * h;
  const double S = h.dot(Ph) + variance;
  const double innovation_m = residual_m - h.dot(x_);
  if (squared(innovation_m) > squared(kAirflowGateSigmas) * S) return;
  const Eigen::Vector2d K = Ph / S;
  x_ += K * innovation_m;
  // Joseph form: P stays positive.
  const Eigen::Matrix2d keep_part = Eigen::Matrix2d::Identity() - K * h.transpose();
  P_ = (keep_part * P_ * keep_part.transpose() + variance * K * K.transpose()).eval();
}

double AirflowEstimator::coefficient() const {
  return std::clamp(x_[1], -kLargestCoefficient, kLargestCoefficient);
}

double AirflowEstimator::sigma() const { return std::sqrt(P_(1, 1)); }

double AirflowEstimator::correction_m(double speed_m_s) const { return coefficient() * squared(speed_m_s); }

double AirflowEstimator::correction_variance_m2(double speed_m_s) const {
  return P_(1, 1) * squared(squared(speed_m_s));
}

}  // namespace isobar
