// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "core/calibration/height_difference.hpp"
#include "core/estimates.hpp"
#include "core/samples.hpp"

namespace isobar::tools {

/// Heights without lag: barometric heights fused with the vertical acceleration of an IMU
/// (InertialAltimeter). The IMU may be mounted at any angle: its attitude comes from gravity and gyro.
/// @param raw heights without low-pass, on the IMU's clock
/// @param sigma_m white noise of a raw height
/// @param source reference of the raw heights
/// @return one height per raw height, at the stamp of an IMU sample; none before gravity is found
HeightSeries inertial_heights(std::span<const ImuSample> imu, const HeightSeries& raw, double sigma_m,
                              HeightSource source);

}  // namespace isobar::tools
