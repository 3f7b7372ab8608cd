// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/noise_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Weight of the initial value, in samples.
constexpr double kInitialSamples = 10.0;

}  // namespace

NoiseEstimator::NoiseEstimator(const Options& options)
    : options_(options),
      variance_(squared(options.initial_sigma)),
      weight_(std::min(kInitialSamples, options.memory_samples)) {}

void NoiseEstimator::set_lag(std::size_t lag) {
  lag = std::clamp<std::size_t>(lag, 1, kMaxLag);
  if (lag == lag_) return;
  lag_ = lag;
  restart();
}

void NoiseEstimator::add(double value) {
  ring_[next_] = value;
  const std::size_t size = ring_.size();
  const double middle = ring_[(next_ + size - lag_) % size];
  const double oldest = ring_[(next_ + size - 2 * lag_) % size];
  next_ = (next_ + 1) % size;
  filled_ = std::min(filled_ + 1, size);
  if (filled_ <= 2 * lag_) return;
  const double difference = value - 2.0 * middle + oldest;
  const double floor_variance = squared(options_.floor_sigma);
  const double sample =
      std::min(squared(difference) / 6.0, options_.clip * std::max(variance_, floor_variance));
  weight_ = std::min(weight_ + 1.0, options_.memory_samples);
  variance_ += (sample - variance_) / weight_;
}

void NoiseEstimator::restart() { filled_ = 0; }

double NoiseEstimator::sigma() const {
  return std::clamp(std::sqrt(variance_), options_.floor_sigma, options_.ceiling_sigma);
}

}  // namespace isobar
