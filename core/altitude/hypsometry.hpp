// SPDX-License-Identifier: BSD-3-Clause
// Height from the ratio of two pressures.
#pragma once

#include <cmath>

#include "core/samples.hpp"

namespace isobar {

/// Specific gas constant of dry air [J/(kg K)] (U.S. Standard Atmosphere 1976: R* / M).
inline constexpr double kDryAirGasConstantJKgK = 287.0528;
/// 0 degrees Celsius [K].
inline constexpr double kZeroCelsiusK = 273.15;

/// Scale height R_dry T_v / g [m] at the column's mean virtual temperature T_v: height per unit of
/// ln(p0 / p1), about 29.3 m per kelvin.
inline double hypsometric_scale_m(double temperature_k) {
  return kDryAirGasConstantJKgK * temperature_k / kGravity;
}

/// Hypsometric equation dz = (R_dry T_v / g) ln(p0 / p1) [m]: height of the level of p1 above that of p0,
/// with constant mean virtual temperature T_v. Positive where p1 < p0.
inline double hypsometric_height_m(double p0_pa, double p1_pa, double temperature_k) {
  return hypsometric_scale_m(temperature_k) * std::log(p0_pa / p1_pa);
}

}  // namespace isobar
