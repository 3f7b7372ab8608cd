// SPDX-License-Identifier: BSD-3-Clause
// Pairs of a sensor's samples and a reference's pressures.
#pragma once

#include <cstddef>
#include <span>

#include "core/calibration/calibration.hpp"
#include "core/calibration/pressure_series.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Outcome of the pairing, in samples of the sensor.
struct PairingCounts {
  std::size_t paired = 0;
  std::size_t without_reference = 0;    ///< outside the reference's log, or in a gap of it
  std::size_t without_temperature = 0;  ///< while other samples of the sensor have one
};

/// Pairs each sample of the sensor with the reference's pressure at the same time (sensor's stamp +
/// `shift_s`): the mean over one interval of the sensor if the reference is at least twice as fast, else the
/// value interpolated linearly. If no sample has a temperature, all temperatures are 0. Adds to `counts`.
std::vector<CalibrationPair> pair_with_reference(std::span<const PressureSample> sensor,
                                                 const PressureSeries& reference, double shift_s,
                                                 PairingCounts& counts);

/// Removes spikes of either sensor, which least squares would follow: pairs whose difference deviates from
/// the median difference by more than 20 median absolute deviations and more than 200 Pa. Returns their
/// number.
std::size_t drop_spikes(std::vector<CalibrationRecording>& recordings);

}  // namespace isobar
