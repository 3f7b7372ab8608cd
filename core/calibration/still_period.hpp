// SPDX-License-Identifier: BSD-3-Clause
// Longest part of a pressure series without motion, and its white noise.
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

/// White noise of one sample, 1 sigma, from second differences d = x[k] - 2 x[k-1] + x[k-2]: median of |d|
/// over 0.6745 sqrt(6). A constant rate cancels, and up to half of the differences may be doors, spikes, gaps
/// and steps. Online counterpart: NoiseEstimator. Valid for independent samples: remove repeats first (a
/// sensor polled faster than it converts). 0 for fewer than three values.
double robust_sigma(std::span<const double> values);

/// Longest run in which the means of successive windows differ by at most max_rate_pa_s * window_s plus noise
/// of `sigma_pa` per sample. A step of that size (0.2 Pa/s over 5 s: 8 cm) ends the run, a slow storm does
/// not. Times in seconds, ascending; a gap longer than a window also ends the run. Empty if no run has two
/// windows.
StillPeriod longest_still_period(std::span<const double> times_s, std::span<const double> pressures_pa,
                                 double sigma_pa, double max_rate_pa_s = 0.2, double window_s = 5.0);

}  // namespace isobar
