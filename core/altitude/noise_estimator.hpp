// SPDX-License-Identifier: BSD-3-Clause
// How noisy a sensor is, seen from its own samples.
#pragma once

#include <array>
#include <cstddef>

namespace isobar {

/// White noise of a sampled signal from its second differences, d = x[k] - 2 x[k-lag] + x[k-2 lag]: E[d^2] =
/// 6 sigma^2, while a constant and a constant rate of change drop out (von Neumann's successive differences,
/// taken once more). Exponential memory; outliers are clipped so that a door does not pass for noise.
class NoiseEstimator {
 public:
  static constexpr std::size_t kMaxLag = 16;
  /// Memory for a barometer, in samples: some seconds at 32 Hz.
  static constexpr double kBarometerMemorySamples = 200.0;

  struct Options {
    double initial_sigma = 1.0;   ///< before enough samples have come, in the signal's unit
    double floor_sigma = 0.0;     ///< the result is never below this …
    double ceiling_sigma = 1e30;  ///< … nor above this
    double memory_samples = 200;  ///< time constant, in samples
    /// Squared differences are clipped at this many times their expectation. 9 costs 0.5 % of a Gaussian's
    /// variance and keeps outliers out, but learns a hundredfold noise only within memory_samples; infinity
    /// learns it at once.
    double clip = 9.0;
  };

  explicit NoiseEstimator(const Options& options);

  /// Sets the lag [samples], 1 … kMaxLag, and forgets the samples (not the estimate) where it changes.
  void set_lag(std::size_t lag);
  void add(double value);
  /// Call after a gap: differences across it mean nothing.
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
  double weight_;  // number of samples behind variance_, up to memory_samples
};

}  // namespace isobar
