// SPDX-License-Identifier: BSD-3-Clause
// Overlapping Allan deviation of a still sensor, and its decomposition into kinds of noise.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace isobar {

/// Allan deviation at one averaging time.
struct AllanPoint {
  std::size_t samples = 0;  ///< m, samples per mean
  double tau_s = 0.0;       ///< m times the sample interval
  double deviation = 0.0;   ///< in the signal's unit
  /// Relative standard deviation of `deviation`, 1 / sqrt(2 (N / m - 1)) (IEEE Std 952, annex C).
  double uncertainty = 0.0;
};

/// Overlapping Allan deviation of samples `dt_s` (> 0) apart, at averaging times a factor of about
/// 10^(1 / `per_decade`) apart, up to half of the series. With means m samples long,
///   s^2(m) = 1 / (2 (N - 2 m + 1)) sum_j (mean_{j + m} - mean_j)^2     (Howe, Allan, Barnes 1981).
/// Empty for fewer than two samples.
std::vector<AllanPoint> overlapping_allan(std::span<const double> values, double dt_s, int per_decade = 8);

/// Coefficients of the kinds of noise; 0 where a kind is not detected.
struct AllanNoise {
  double white = 0.0;             ///< N [unit sqrt(s)]: s = N / sqrt(tau), slope -1/2. Sigma of one sample is
                                  ///< N / sqrt(dt)
  double bias_instability = 0.0;  ///< B [unit]: s = sqrt(2 ln 2 / pi) B = 0.664 B, slope 0
  double walk = 0.0;              ///< K [unit / sqrt(s)]: s = K sqrt(tau / 3), slope +1/2
  double ramp = 0.0;              ///< R [unit / s]: s = R tau / sqrt(2), slope +1; weather's steady trend
};

/// Fits s^2 = sum of the four kinds, none negative, by least squares weighted with each point's uncertainty.
/// The random walk is discrete: s^2 = K^2 dt (2 m^2 + 1) / (6 m). Points with a relative uncertainty above
/// one half are left out. All zero if there are no points.
AllanNoise identify_noise(std::span<const AllanPoint> points);

/// Deviation of `noise` at the averaging time of a point.
double modelled_deviation(const AllanNoise& noise, const AllanPoint& point);

}  // namespace isobar
