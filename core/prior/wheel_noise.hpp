// SPDX-License-Identifier: BSD-3-Clause
// Noise of a wheel sample: as its sender states it, else as configured.
#pragma once

#include <cmath>
#include <limits>

#include "core/plausibility.hpp"
#include "core/samples.hpp"
#include "core/squared.hpp"

namespace isobar {

/// Variance of a speed that is believed [m^2/s^2], 0.01 to 3 m/s: on its suspension a chassis sways by more than the
/// lowest against wheels that stand, and place holders such as 1e-9 or 1e6 lie outside.
inline constexpr PlausibleRange kBelievedSpeedVarianceM2S2{1e-4, 10.0};
/// Variance of a turn rate that is believed [rad^2/s^2], 0.001 to 3 rad/s.
inline constexpr PlausibleRange kBelievedTurnVarianceRad2S2{1e-6, 10.0};

/// Makes unknown (NaN) what is not believed of the sample's variances.
/// @return false when the variance of the forward speed or of the turn rate is stated and not believed. That of the
///         sideways speed does not count: a differential drive does not measure it and states anything.
inline bool keep_believed_variances(WheelSample& sample) {
  const auto keep = [](double& stated, const PlausibleRange& range) {
    if (std::isnan(stated) || range.holds(stated)) return true;
    stated = std::numeric_limits<double>::quiet_NaN();
    return false;
  };
  keep(sample.vy_variance_m2_s2, kBelievedSpeedVarianceM2S2);
  const bool forward = keep(sample.vx_variance_m2_s2, kBelievedSpeedVarianceM2S2);
  const bool turn = keep(sample.wz_variance_rad2_s2, kBelievedTurnVarianceRad2S2);
  return forward && turn;
}

/// Variance of the constant part of a wheel's error; the share of the speed comes on top, since it is slip, which
/// no encoder knows.
/// @param stated by the sender, believed; NaN: unknown
/// @param configured_sigma used where it is unknown
[[nodiscard]] inline double constant_variance(double stated, double configured_sigma) {
  return std::isnan(stated) ? squared(configured_sigma) : stated;
}

}  // namespace isobar
