// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/barometer_model.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::simulation {

BarometerErrors BarometerErrors::draw(Random random, bool base_station) {
  BarometerErrors errors;
  // DPS310 data sheet v1.2: absolute accuracy +-1 hPa, relative +-0.06 hPa, noise 0.35 Pa rms at the
  // oversampling that 32 Hz allows, temperature sensitivity 0.5 Pa/K.
  errors.offset_pa = random.normal(40.0);
  errors.scale = random.normal(5e-5);
  errors.noise_pa = random.uniform(0.30, 0.40);
  errors.flicker_pa = random.uniform(0.03, 0.10);
  errors.drift_pa_k = std::clamp(random.normal(0.25), -0.5, 0.5);
  errors.drift_pa_k2 = random.normal(0.01);
  // Self-heating next to other electronics: some kelvins within minutes; less in a ventilated base station.
  errors.warm_up_k = base_station ? random.uniform(0.3, 1.2) : random.uniform(1.5, 4.0);
  errors.warm_up_tau_s = random.uniform(180.0, 420.0);
  errors.powered_for_s = base_station ? random.uniform(300.0, 2400.0) : random.uniform(60.0, 600.0);
  // Data sheet: temperature accuracy +-0.5 K.
  errors.temperature_offset_k = random.normal(0.3);
  errors.temperature_noise_k = 0.01;
  return errors;
}

BarometerModel::BarometerModel(const BarometerErrors& errors, Random random)
    : errors_(errors), random_(random), flicker_(errors.flicker_pa, 60.0, Random(random_.next())) {}

PressureSample BarometerModel::sample(double time_s, double true_pa, double air_temperature_c) {
  const double warm_k =
      errors_.warm_up_k * (1.0 - std::exp(-(time_s + errors_.powered_for_s) / errors_.warm_up_tau_s));
  PressureSample sample;
  sample.pressure_pa = true_pa * (1.0 + errors_.scale) + errors_.offset_pa + errors_.drift_pa_k * warm_k +
                       errors_.drift_pa_k2 * warm_k * warm_k + flicker_.step(1.0 / kRateHz) +
                       random_.normal(errors_.noise_pa);
  sample.temperature_c =
      air_temperature_c + warm_k + errors_.temperature_offset_k + random_.normal(errors_.temperature_noise_k);
  return sample;
}

}  // namespace isobar::simulation
