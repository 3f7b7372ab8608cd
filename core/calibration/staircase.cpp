// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/staircase.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/statistics/distribution.hpp"

namespace isobar {

namespace {

/// Index range [first, last) of the samples within [begin_s, end_s).
std::pair<std::size_t, std::size_t> samples_within(const HeightTrack& track, double begin_s, double end_s) {
  const auto at = [&](double time_s) {
    return static_cast<std::size_t>(std::lower_bound(track.times_s.begin(), track.times_s.end(), time_s) -
                                    track.times_s.begin());
  };
  return {at(begin_s), std::max(at(begin_s), at(end_s))};
}

}  // namespace

std::vector<Plateau> plateaus_between(const HeightTrack& track, std::span<const double> step_times_s,
                                      double step_m, double after_s, double before_s) {
  std::vector<Plateau> plateaus;
  double mean_before_m = 0.0;
  for (std::size_t i = 0; i <= step_times_s.size(); ++i) {
    const double begin_s = i == 0 ? track.times_s.front() : step_times_s[i - 1];
    const double end_s = i < step_times_s.size() ? step_times_s[i] : track.times_s.back();
    const auto [first, last] = samples_within(track, begin_s, end_s);
    double mean_m = mean_before_m;
    if (last > first) {
      mean_m = 0.0;
      for (std::size_t k = first; k < last; ++k)
        mean_m += track.heights_m[k] / static_cast<double>(last - first);
    }
    Plateau plateau{i == 0 ? begin_s : begin_s + after_s, i < step_times_s.size() ? end_s - before_s : end_s};
    if (i > 0)
      plateau.true_height_m = plateaus.back().true_height_m + std::copysign(step_m, mean_m - mean_before_m);
    plateaus.push_back(plateau);
    mean_before_m = mean_m;
  }
  return plateaus;
}

std::vector<Plateau> shortened(std::span<const Plateau> plateaus, double after_s, double before_s) {
  std::vector<Plateau> result(plateaus.begin(), plateaus.end());
  for (Plateau& plateau : result) {
    plateau.begin_s += after_s;
    plateau.end_s -= before_s;
  }
  return result;
}

StaircaseErrors staircase_errors(const HeightTrack& track, std::span<const Plateau> plateaus) {
  StaircaseErrors errors;
  bool has_before = false;
  double mean_before_m = 0.0;
  double true_before_m = 0.0;
  for (const Plateau& plateau : plateaus) {
    const auto [first, last] = samples_within(track, plateau.begin_s, plateau.end_s);
    if (first == last) continue;
    double mean_m = 0.0;
    for (std::size_t k = first; k < last; ++k)
      mean_m += track.heights_m[k] / static_cast<double>(last - first);
    const double expected_m = mean_before_m + plateau.true_height_m - true_before_m;
    if (has_before) {
      errors.steps_m.push_back(mean_m - expected_m);
      for (std::size_t k = first; k < last; ++k) errors.samples_m.push_back(track.heights_m[k] - expected_m);
    }
    has_before = true;
    mean_before_m = mean_m;
    true_before_m = plateau.true_height_m;
  }
  return errors;
}

ErrorFigures error_figures(std::span<const double> errors_m) {
  std::vector<double> sizes;
  for (const double error : errors_m) sizes.push_back(std::abs(error));
  ErrorFigures figures;
  figures.count = sizes.size();
  double mean_m = 0.0;
  for (const double size : sizes) mean_m += size / static_cast<double>(sizes.size());
  double squares = 0.0;
  for (const double size : sizes) squares += (size - mean_m) * (size - mean_m);
  figures.sd_m =
      sizes.size() > 1 ? std::sqrt(squares / static_cast<double>(sizes.size() - 1)) : Distribution::kNone;
  figures.median_m = summarize(std::move(sizes)).median;
  return figures;
}

}  // namespace isobar
