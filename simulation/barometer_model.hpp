// SPDX-License-Identifier: BSD-3-Clause
// Model of a DPS310 barometer: its output after the chip's own compensation.
#pragma once

#include "core/samples.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// Errors of one chip in its housing. The defaults are zero, for tests.
struct BarometerErrors {
  double offset_pa = 0.0;
  double scale = 0.0;          ///< relative error of the pressure
  double noise_pa = 0.0;       ///< white noise, standard deviation of a sample
  double flicker_pa = 0.0;     ///< slow wander, rms, tau 60 s
  double warm_up_k = 0.0;      ///< final self-heating of the chip
  double warm_up_tau_s = 1.0;  ///< time constant of the self-heating
  double powered_for_s = 0.0;  ///< time since power-on at time 0
  double drift_pa_k = 0.0;     ///< residual temperature error after compensation, linear in the self-heating
  double drift_pa_k2 = 0.0;    ///< and quadratic
  double temperature_offset_k = 0.0;
  double temperature_noise_k = 0.0;

  /// Random errors of data-sheet size. A base station has been powered for longer than a robot.
  [[nodiscard]] static BarometerErrors draw(Random random, bool base_station);
};

/// One barometer. Samples must be taken in time order.
class BarometerModel {
 public:
  static constexpr double kRateHz = 32.0;
  /// Duration of a conversion. A sample is the mean pressure over this time and is read at its end.
  static constexpr double kConversionS = 0.028;

  BarometerModel(const BarometerErrors& errors, Random random);
  /// Sample read at `time_s`; `true_pa`: pressure in the middle of the conversion. The caller sets stamp_ns.
  [[nodiscard]] PressureSample sample(double time_s, double true_pa, double air_temperature_c);

 private:
  BarometerErrors errors_;
  Random random_;
  GaussMarkov flicker_;
};

}  // namespace isobar::simulation
