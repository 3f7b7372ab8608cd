// SPDX-License-Identifier: BSD-3-Clause
// Operating ranges of MEMS barometers. Narrower than the plausible ranges of core/plausibility.hpp, which
// hold for every sensor: the chips specify no result outside.
#pragma once

#include "core/plausibility.hpp"

namespace isobar {

inline constexpr PlausibleRange kMemsPressurePa{30e3, 120e3};
inline constexpr PlausibleRange kMemsTemperatureC{-40.0, 85.0};
static_assert(kPlausiblePressurePa.holds(kMemsPressurePa.lowest) &&
              kPlausiblePressurePa.holds(kMemsPressurePa.highest));
static_assert(kPlausibleTemperatureC.holds(kMemsTemperatureC.lowest) &&
              kPlausibleTemperatureC.holds(kMemsTemperatureC.highest));

/// The rule that a compensated result breaks, a static text; nullptr when it lies in both ranges.
[[nodiscard]] inline const char* outside_operation(double pressure_pa, double temperature_c) noexcept {
  if (!kMemsTemperatureC.holds(temperature_c)) return "temperature outside -40 ... 85 degrees C";
  if (!kMemsPressurePa.holds(pressure_pa)) return "pressure outside 300 ... 1200 hPa";
  return nullptr;
}

}  // namespace isobar
