// SPDX-License-Identifier: BSD-3-Clause
// Pressure at a height in isothermal air, for simulated barometers.
#pragma once

#include <cmath>

#include "core/altitude/hypsometry.hpp"

namespace isobar::test {

/// Pressure `height_m` above the level of p0 [Pa]: the inverse of hypsometric_height_m().
inline double hypsometric_pressure_pa(double p0_pa, double height_m, double temperature_k) {
  return p0_pa * std::exp(-height_m / hypsometric_scale_m(temperature_k));
}

}  // namespace isobar::test
