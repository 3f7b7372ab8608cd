// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "core/calibration/calibration.hpp"
#include "core/calibration/pressure_series.hpp"
#include "core/samples.hpp"

namespace isobar {

/// What became of a sensor's samples.
struct PairingCounts {
  std::size_t paired = 0;
  std::size_t without_reference = 0;    ///< outside of the reference's log, or in a gap of it
  std::size_t without_temperature = 0;  ///< though the sensor's others have one
};

/// Each sample of the sensor beside the reference's pressure at the same moment: the mean over one interval
/// of the sensor if the reference is faster, else the value between its samples. Where no sample has a
/// temperature, it is taken as 0.
std::vector<CalibrationPair> pair_with_reference(std::span<const PressureSample> sensor,
                                                 const PressureSeries& reference, double shift_s,
                                                 PairingCounts& counts);

/// Takes out pairs whose difference lies further from the median of all differences than twenty times their
/// median deviation and 200 Pa: spikes of one of the two, which least squares would follow. Returns how many.
std::size_t drop_spikes(std::vector<CalibrationRecording>& recordings);

}  // namespace isobar
