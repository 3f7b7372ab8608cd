// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/hypsometry.hpp"

#include <algorithm>

namespace isobar {

double barometric_height_m(double p0_pa, double p1_pa, double t0_k, double lapse_k_m) {
  const double log_ratio = std::log(p0_pa / p1_pa);
  const double exponent = -kDryAirGasConstant * lapse_k_m / kGravity * log_ratio;
  // (1 - e^x) / x tends to -1: where x is tiny the quotient below would be 0/0.
  if (std::abs(exponent) < 1e-12) return hypsometric_scale_m(t0_k) * log_ratio;
  return -t0_k / lapse_k_m * std::expm1(exponent);
}

double integrated_height_m(double p0_pa, double p1_pa, const std::function<double(double)>& temperature_k,
                           int steps) {
  steps = std::max(steps, 1);
  const double step = std::log(p0_pa / p1_pa) / steps;
  const auto slope = [&](double height_m) { return hypsometric_scale_m(temperature_k(height_m)); };
  double height_m = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double k1 = slope(height_m);
    const double k2 = slope(height_m + 0.5 * step * k1);
    const double k3 = slope(height_m + 0.5 * step * k2);
    const double k4 = slope(height_m + step * k3);
    height_m += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return height_m;
}

}  // namespace isobar
