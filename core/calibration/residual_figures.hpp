// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace isobar {

/// Residual reference - compensated [Pa].
struct ResidualFigures {
  double mean_pa = 0.0;
  double median_abs_pa = 0.0;  ///< median of |r|
  double sd_pa = 0.0;          ///< of r about its mean
  double rms_pa = 0.0;         ///< of r
  double p95_abs_pa = 0.0;     ///< 95th percentile of |r|
};
ResidualFigures residual_figures(std::span<const double> residuals_pa);

/// White noise of one sample, 1 sigma, from residuals in order of time. A constant and a steady drift cancel
/// in second differences, E d^2 = 6 sigma^2; the median of |d| stands for their mean square, so that gaps and
/// spikes do no harm. 0 with fewer than three.
double white_noise_pa(std::span<const double> residuals_pa);

}  // namespace isobar
