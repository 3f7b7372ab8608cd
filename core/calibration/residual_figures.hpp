// SPDX-License-Identifier: BSD-3-Clause
// Figures of the residuals of a calibration.
#pragma once

#include <span>

namespace isobar {

/// Figures of the residuals r = reference - compensated.
struct ResidualFigures {
  double mean_pa = 0.0;
  double median_abs_pa = 0.0;  ///< median of |r|
  double sd_pa = 0.0;          ///< standard deviation of r
  double rms_pa = 0.0;         ///< of r
  double p95_abs_pa = 0.0;     ///< 95th percentile of |r|
};

/// All zero if there are no residuals.
ResidualFigures residual_figures(std::span<const double> residuals_pa);

}  // namespace isobar
