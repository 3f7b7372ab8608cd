// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "core/calibration/height_difference.hpp"
#include "core/estimates.hpp"
#include "core/samples.hpp"

namespace isobar::tools {

/// Heights without lag: those of `raw` (no low-pass) carried along by the vertical acceleration of an IMU
/// (InertialAltimeter). Its attitude is found from gravity and gyro, so it may be mounted at any angle. Both
/// clocks are one. `sigma_m`: white noise of a raw height; `source`: what it was measured against. One height
/// for each raw one, at the IMU's time; none before gravity is known.
HeightSeries inertial_heights(std::span<const ImuSample> imu, const HeightSeries& raw, double sigma_m,
                              HeightSource source);

}  // namespace isobar::tools
