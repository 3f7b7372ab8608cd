// SPDX-License-Identifier: BSD-3-Clause
// The part of a pressure series in which the sensor neither rose nor sank, and its white noise.
#pragma once

#include <cstddef>
#include <span>

namespace isobar {

/// Samples [begin, end) of a series.
struct StillPeriod {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t count() const { return end - begin; }
};

/// White noise of one sample, 1 sigma, from second differences d = x[k] - 2 x[k-1] + x[k-2]: the median of
/// |d| over 0.6745 sqrt(6). A constant rate of change drops out, and up to half of the differences may be
/// doors, spikes and steps; NoiseEstimator is the same in a stream. Right for noise that is independent from
/// sample to sample: take out repeats first (a sensor polled faster than it converts). 0 for fewer than
/// three.
double robust_sigma(std::span<const double> values);

/// The longest run in which the pressure moves no faster than `max_rate_pa_s` from one `window_s` to the
/// next, beyond what `sigma_pa` explains. Means over a window are compared, so that a step of max_rate times
/// window (0.2 Pa/s over 5 s: 8 cm) ends the run, and a slow storm does not. Stamps in seconds, ascending; a
/// gap longer than a window ends a run, too. Empty where there is none of at least two windows.
StillPeriod longest_still_period(std::span<const double> times_s, std::span<const double> pressures_pa,
                                 double sigma_pa, double max_rate_pa_s = 0.2, double window_s = 5.0);

}  // namespace isobar
