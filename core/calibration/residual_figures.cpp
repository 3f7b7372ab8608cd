// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/residual_figures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/statistics/distribution.hpp"

namespace isobar {

ResidualFigures residual_figures(std::span<const double> residuals_pa) {
  ResidualFigures figures;
  if (residuals_pa.empty()) return figures;
  const auto count = static_cast<double>(residuals_pa.size());
  double sum = 0.0;
  for (const double r : residuals_pa) sum += r;
  figures.mean_pa = sum / count;
  double squares = 0.0;
  std::vector<double> absolutes;
  for (const double r : residuals_pa) {
    squares += (r - figures.mean_pa) * (r - figures.mean_pa);
    absolutes.push_back(std::abs(r));
  }
  figures.sd_pa = std::sqrt(squares / count);
  figures.rms_pa = std::hypot(figures.mean_pa, figures.sd_pa);
  std::sort(absolutes.begin(), absolutes.end());
  figures.median_abs_pa = quantile(absolutes, 0.5);
  figures.p95_abs_pa = quantile(absolutes, 0.95);
  return figures;
}

}  // namespace isobar
