// SPDX-License-Identifier: BSD-3-Clause
// A DPS310: what the chip reports after its own compensation.
#pragma once

#include "core/samples.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// Errors of one chip in its housing. Defaults are none, for tests.
struct BarometerErrors {
  double offset_pa = 0.0;
  double scale = 0.0;       ///< relative, of the pressure
  double noise_pa = 0.0;    ///< white, a sample
  double flicker_pa = 0.0;  ///< slow wander
  double warm_up_k = 0.0;   ///< final self-heating of the chip
  double warm_up_tau_s = 1.0;
  double powered_for_s = 0.0;  ///< at time 0
  double drift_pa_k = 0.0;     ///< what the compensation leaves
  double drift_pa_k2 = 0.0;
  double temperature_offset_k = 0.0;
  double temperature_noise_k = 0.0;

  /// The robot's is switched on with the robot, the base station's earlier.
  [[nodiscard]] static BarometerErrors draw(Random random, bool base_station);
};

/// Samples must be taken in time order.
class BarometerModel {
 public:
  static constexpr double kRateHz = 32.0;
  /// Each result is the mean of a conversion that began this long before it was read.
  static constexpr double kConversionS = 0.028;

  BarometerModel(const BarometerErrors& errors, Random random);
  /// true_pa: pressure in the middle of the conversion. The stamp is left to the caller.
  [[nodiscard]] PressureSample sample(double time_s, double true_pa, double air_temperature_c);

 private:
  BarometerErrors errors_;
  Random random_;
  GaussMarkov flicker_;
};

}  // namespace isobar::simulation
