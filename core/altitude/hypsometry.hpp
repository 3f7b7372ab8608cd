// SPDX-License-Identifier: BSD-3-Clause
// Heights from pressures. p0 is the pressure at the lower (reference) level, p1 at the level in question;
// the result is positive where p1 < p0.
#pragma once

#include <cmath>
#include <functional>

#include "core/samples.hpp"

namespace isobar {

/// Specific gas constant of dry air [J/(kg K)] (U.S. Standard Atmosphere 1976: R* / M).
inline constexpr double kDryAirGasConstant = 287.0528;
/// 0 degrees Celsius [K].
inline constexpr double kZeroCelsiusK = 273.15;
/// Lapse rate of the standard atmosphere's troposphere [K/m], counted as temperature lost a metre of height.
inline constexpr double kStandardLapseRate = 0.0065;

/// Metres a unit of ln(p0/p1) at mean virtual temperature `temperature_k`: R_dry T_v / g (about 29.3 m/K).
inline double hypsometric_scale_m(double temperature_k) {
  return kDryAirGasConstant * temperature_k / kGravity;
}

/// Hypsometric equation with constant mean virtual temperature: dz = (R_dry T_v / g) ln(p0 / p1) [m].
inline double hypsometric_height_m(double p0_pa, double p1_pa, double temperature_k) {
  return hypsometric_scale_m(temperature_k) * std::log(p0_pa / p1_pa);
}

/// Pressure `height_m` above the level of p0 in isothermal air: the inverse of hypsometric_height_m().
inline double hypsometric_pressure_pa(double p0_pa, double height_m, double temperature_k) {
  return p0_pa * std::exp(-height_m / hypsometric_scale_m(temperature_k));
}

/// Barometric formula of a layer whose temperature falls by `lapse_k_m` a metre from `t0_k` at p0 [m]:
/// dz = (T0 / L) (1 - (p1/p0)^(R L / g)). A lapse rate of zero is the isothermal limit.
double barometric_height_m(double p0_pa, double p1_pa, double t0_k, double lapse_k_m = kStandardLapseRate);

/// Generic hypsometric equation, ln(p1/p0) = -(g/R_dry) int_0^dz dz'/T(z'), solved for dz [m].
/// `temperature_k` gives the virtual temperature at a height above p0's level, positive and continuous.
/// Integrates dz/d(ln p) = -R T(z)/g with Runge-Kutta 4 in `steps` (>= 1) equal steps of ln p; error of order
/// steps^-4.
double integrated_height_m(double p0_pa, double p1_pa, const std::function<double(double)>& temperature_k,
                           int steps = 64);

}  // namespace isobar
