// SPDX-License-Identifier: BSD-3-Clause
// What one pressure sensor is worth, from a series of its samples.
#pragma once

#include <span>
#include <vector>

#include "core/calibration/allan_deviation.hpp"
#include "core/calibration/still_period.hpp"

namespace isobar {

struct SensorNoise {
  /// Mean time between samples [s]: where a repeated value was left out here and there, averaging times are
  /// right on average.
  double interval_s = 0.0;
  StillPeriod still;  ///< what the rest is from
  /// White noise of one sample [Pa], from second differences: drift and motion do not count, noise that one
  /// sample shares with the next does not either (a filter inside the chip makes this too small: compare
  /// with `parts.white`).
  double sigma_pa = 0.0;
  std::vector<AllanPoint> allan;  ///< overlapping Allan deviation [Pa]
  AllanNoise parts;
  /// Sigma of one sample that has the white part of the Allan deviation [Pa].
  [[nodiscard]] double allan_sigma_pa() const;
};

/// Studies the longest still period of a series without repeats, stamps ascending [s]. Samples count as
/// equally spaced. `still.count()` is 0 where nothing was still for ten seconds, and the rest is empty.
SensorNoise study_noise(std::span<const double> times_s, std::span<const double> pressures_pa);

/// The same, of all of a series that is known to be still.
SensorNoise study_still_noise(std::span<const double> times_s, std::span<const double> pressures_pa);

}  // namespace isobar
