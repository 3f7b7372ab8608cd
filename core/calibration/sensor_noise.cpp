// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/sensor_noise.hpp"

#include <cmath>

namespace isobar {
namespace {

double mean_interval_s(std::span<const double> times_s) {
  if (times_s.size() < 2) return 0.0;
  return (times_s.back() - times_s.front()) / static_cast<double>(times_s.size() - 1);
}

}  // namespace

double SensorNoise::allan_sigma_pa() const {
  return interval_s > 0.0 ? parts.white / std::sqrt(interval_s) : 0.0;
}

SensorNoise study_still_noise(std::span<const double> times_s, std::span<const double> pressures_pa) {
  SensorNoise noise;
  noise.interval_s = mean_interval_s(times_s);
  noise.still = {0, pressures_pa.size()};
  noise.sigma_pa = robust_sigma(pressures_pa);
  if (!(noise.interval_s > 0.0)) return noise;
  noise.allan = overlapping_allan(pressures_pa, noise.interval_s);
  noise.parts = identify_noise(noise.allan);
  return noise;
}

SensorNoise study_noise(std::span<const double> times_s, std::span<const double> pressures_pa) {
  const StillPeriod still = longest_still_period(times_s, pressures_pa, robust_sigma(pressures_pa));
  if (still.count() == 0) return {};
  SensorNoise noise = study_still_noise(times_s.subspan(still.begin, still.count()),
                                        pressures_pa.subspan(still.begin, still.count()));
  noise.still = still;
  return noise;
}

}  // namespace isobar
