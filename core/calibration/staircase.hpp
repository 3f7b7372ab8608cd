// SPDX-License-Identifier: BSD-3-Clause
// Steps of known height in a measured height: detection, and errors between them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace isobar {

/// A measured height against time.
struct HeightTrack {
  std::vector<double> times_s;  ///< ascending
  std::vector<double> heights_m;
};

/// Prior knowledge of the steps.
struct StepSearch {
  double step_m = 0.03;      ///< height of every step, > 0
  std::size_t steps = 0;     ///< number of steps; 0: unknown
  double min_dwell_s = 3.0;  ///< shortest duration of a level
};

/// Detected steps.
struct FoundSteps {
  std::vector<double> times_s;  ///< ascending; their number may differ from StepSearch::steps
  /// Standard deviation of each time due to white noise [s]: sqrt(26) s^2 / step^2 with s^2 the noise density
  /// (argmax of a two-sided Brownian motion with drift, Yao 1987).
  double uncertainty_s = 0.0;
};

/// Times at which the height goes up or down by one step: the most likely sequence of levels (Viterbi 1967)
/// over short means. Cost: squared deviation from the level, plus a penalty per step that exceeds what noise
/// or a draft of min_dwell_s can gain. Each sequence tracks its own drift with a time constant of a minute.
/// If the number of steps is known, the penalty is adjusted to obtain it.
FoundSteps find_steps(const HeightTrack& track, const StepSearch& search);

/// A level, and the part of its duration that is evaluated.
struct Plateau {
  double begin_s = 0.0;
  double end_s = 0.0;
  double true_height_m = 0.0;
};

/// Plateaus between steps, without the first `after_s` and the last `before_s`. Their true heights are
/// multiples of `step_m`, up or down as the track goes. The ends of the track also end plateaus.
std::vector<Plateau> plateaus_between(const HeightTrack& track, std::span<const double> step_times_s,
                                      double step_m, double after_s, double before_s);

/// The same plateaus, evaluated part shortened by `after_s` and `before_s`.
std::vector<Plateau> shortened(std::span<const Plateau> plateaus, double after_s, double before_s);

/// Errors of a settled track against the true staircase.
struct StaircaseErrors {
  /// Per step: mean of a plateau minus mean of the previous one, minus the true difference [m].
  std::vector<double> steps_m;
  /// Per settled sample: its height above the mean of the previous plateau, minus the true difference [m];
  /// includes noise. None for samples of the first plateau.
  std::vector<double> samples_m;
};

/// Plateaus without a sample are left out.
StaircaseErrors staircase_errors(const HeightTrack& track, std::span<const Plateau> plateaus);

/// Median and standard deviation of |error|, the paper's figures (0.674 and 0.603 sigma for zero-mean normal
/// errors). NaN if there are no errors.
struct ErrorFigures {
  std::size_t count = 0;
  double median_m = 0.0;
  double sd_m = 0.0;
};
ErrorFigures error_figures(std::span<const double> errors_m);

}  // namespace isobar
