// SPDX-License-Identifier: BSD-3-Clause
// Noise of one pressure sensor, from a series of its samples.
#pragma once

#include <span>
#include <vector>

#include "core/calibration/allan_deviation.hpp"
#include "core/calibration/still_period.hpp"

namespace isobar {

/// Noise figures of a still sensor.
struct SensorNoise {
  /// Mean time between samples [s]: correct on average where repeated values were removed.
  double interval_s = 0.0;
  StillPeriod still;  ///< samples that the figures are from
  /// White noise of one sample [Pa], from second differences: excludes drift and motion, but also noise
  /// correlated from sample to sample (a filter inside the chip makes it too small: compare with
  /// parts.white).
  double sigma_pa = 0.0;
  std::vector<AllanPoint> allan;  ///< overlapping Allan deviation [Pa]
  AllanNoise parts;
  /// Standard deviation of one sample for the white part of the Allan deviation [Pa].
  [[nodiscard]] double allan_sigma_pa() const;
};

/// Noise in the longest still period of a series without repeats; times ascending [s], samples taken as
/// equally spaced. Empty, with still.count() 0, if there is no still period of ten seconds.
SensorNoise study_noise(std::span<const double> times_s, std::span<const double> pressures_pa);

/// Noise of a whole series that is known to be still.
SensorNoise study_still_noise(std::span<const double> times_s, std::span<const double> pressures_pa);

}  // namespace isobar
