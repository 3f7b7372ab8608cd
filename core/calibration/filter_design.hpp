// SPDX-License-Identifier: BSD-3-Clause
// Design of PressureFilter from sensor noise, sample rate, and the wanted lag, bandwidth or output noise.
#pragma once

#include <cmath>
#include <numbers>

#include "core/squared.hpp"

namespace isobar {

/// Steady state of PressureFilter, y += K (p - y), for samples `dt` apart with white noise `sigma` each.
struct FilterDesign {
  double gain = 1.0;            ///< K, 0 … 1
  double walk_pa_sqrt_s = 0.0;  ///< random walk of PressureFilter that gives this gain
  /// Lag behind a pressure that changes at a constant rate, dt (1 - K) / K [s]; the filter's group delay at 0
  /// Hz. PressureFilter::delay_s() converges to it.
  double delay_s = 0.0;
  double bandwidth_hz = 0.0;     ///< -3 dB frequency; the Nyquist frequency if there is none below
  double output_sigma_pa = 0.0;  ///< noise of the output, sigma sqrt(K / (2 - K))
};

/// Design for a gain. `sigma_pa` > 0, `dt_s` > 0, 0 < `gain` < 1.
///
/// With P the variance before an update, R = sigma^2 and q the walk's variance per second, the steady state
/// has K = P / (P + R) and P = (1 - K) P + q dt, hence q dt / R = K^2 / (1 - K). |H(w)|^2 = K^2 / (1 - 2 (1 -
/// K) cos(w dt) + (1 - K)^2) is 1/2 where cos(w dt) = 1 - K^2 / (2 (1 - K)).
inline FilterDesign design_for_gain(double sigma_pa, double dt_s, double gain) {
  FilterDesign design;
  design.gain = gain;
  design.walk_pa_sqrt_s = sigma_pa * gain / std::sqrt((1.0 - gain) * dt_s);
  design.delay_s = dt_s * (1.0 - gain) / gain;
  const double cosine = std::fmax(-1.0, 1.0 - 0.5 * gain * gain / (1.0 - gain));
  design.bandwidth_hz = std::acos(cosine) / (2.0 * std::numbers::pi * dt_s);
  design.output_sigma_pa = sigma_pa * std::sqrt(gain / (2.0 - gain));
  return design;
}

/// Design for a lag `lag_s` (> 0): K = dt / (lag + dt), hence the walk sigma sqrt(dt / (lag (lag + dt))). The
/// height of a robot climbing at v is late by v lag, unless its stamp is corrected for the delay.
inline FilterDesign design_for_lag(double sigma_pa, double dt_s, double lag_s) {
  return design_for_gain(sigma_pa, dt_s, dt_s / (lag_s + dt_s));
}

/// Design for a -3 dB frequency `bandwidth_hz`, 0 < bandwidth < 1 / (2 dt): with
/// c = cos(2 pi f dt), K = c - 1 + sqrt((c - 1) (c - 3)). For small f dt the lag is 1 / (2 pi f).
inline FilterDesign design_for_bandwidth(double sigma_pa, double dt_s, double bandwidth_hz) {
  const double below = std::cos(2.0 * std::numbers::pi * bandwidth_hz * dt_s) - 1.0;
  return design_for_gain(sigma_pa, dt_s, below + std::sqrt(below * (below - 2.0)));
}

/// Design for the output noise `output_sigma_pa`, 0 < output < sigma: with
/// r = (output / sigma)^2, K = 2 r / (1 + r).
inline FilterDesign design_for_noise(double sigma_pa, double dt_s, double output_sigma_pa) {
  const double ratio = squared(output_sigma_pa / sigma_pa);
  return design_for_gain(sigma_pa, dt_s, 2.0 * ratio / (1.0 + ratio));
}

}  // namespace isobar
