// SPDX-License-Identifier: BSD-3-Clause
// Online estimate of a sensor's white noise from its own samples.
#pragma once

#include <array>
#include <cstddef>

namespace isobar {

/// Standard deviation of white noise from second differences d = x[k] - 2 x[k-lag] + x[k-2 lag]: E[d^2] =
/// 6 sigma^2, while a constant and a constant rate cancel (von Neumann's successive differences, taken
/// twice). Exponential memory; outliers are clipped so that an opening door does not count as noise.
class NoiseEstimator {
 public:
  static constexpr std::size_t kMaxLag = 16;
  /// Memory for a barometer [samples]: some seconds at 32 Hz.
  static constexpr double kBarometerMemorySamples = 200.0;

  struct Options {
    double initial_sigma = 1.0;   ///< until enough samples have come; unit of the signal, as all sigmas
    double floor_sigma = 0.0;     ///< lower bound of the result
    double ceiling_sigma = 1e30;  ///< upper bound of the result
    double memory_samples = 200;  ///< time constant [samples]
    /// Clip level of squared differences, as a multiple of their expectation. 9 costs 0.5 % of a Gaussian's
    /// variance and rejects outliers, but needs memory_samples to learn a hundredfold noise; infinity learns
    /// it at once.
    double clip = 9.0;
  };

  explicit NoiseEstimator(const Options& options);

  /// Sets the lag [samples], clamped to 1 … kMaxLag. A change discards the samples, not the estimate.
  void set_lag(std::size_t lag);
  void add(double value);
  /// Call after a gap: a difference across it is not noise.
  void restart();

  [[nodiscard]] double sigma() const;
  [[nodiscard]] double variance() const { return sigma() * sigma(); }

 private:
  Options options_;
  std::array<double, 2 * kMaxLag + 1> ring_{};
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::size_t lag_ = 1;
  double variance_;
  double weight_;  // samples averaged in variance_, up to memory_samples
};

}  // namespace isobar
