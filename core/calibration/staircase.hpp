// SPDX-License-Identifier: BSD-3-Clause
// A height that goes in known steps: where the steps are, and how far a measured height is off between them.
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

struct StepSearch {
  double step_m = 0.03;      ///< height of every step, > 0
  std::size_t steps = 0;     ///< how many there are; 0: as many as are seen
  double min_dwell_s = 3.0;  ///< no level is shorter
};

struct FoundSteps {
  std::vector<double> times_s;  ///< ascending; not steps.size() where so many cannot be found
  /// 1 sigma of each time that white noise leaves: sqrt(26) s^2 / step^2 with s^2 the noise's density (argmax
  /// of a two-sided Brownian motion with drift, Yao 1987) [s].
  double uncertainty_s = 0.0;
};

/// Times at which a track of levels goes up or down by one step. The most likely sequence of levels (Viterbi
/// 1967) over short means: a wrong level costs its square, a step costs a penalty that neither noise nor a
/// draft of min_dwell_s is worth. Each sequence carries its own estimate of what drifts, with a memory of a
/// minute. Where the number of steps is known, the penalty is moved until it comes out.
FoundSteps find_steps(const HeightTrack& track, const StepSearch& search);

/// A level, and the span of it that counts.
struct Plateau {
  double begin_s = 0.0;
  double end_s = 0.0;
  double true_height_m = 0.0;
};

/// Plateaus between steps, of which the first `after_s` and the last `before_s` do not count; their true
/// heights are multiples of `step_m`, up or down as the track went. The track's own ends end plateaus, too.
std::vector<Plateau> plateaus_between(const HeightTrack& track, std::span<const double> step_times_s,
                                      double step_m, double after_s, double before_s);

/// The same plateaus, with the part that counts shortened.
std::vector<Plateau> shortened(std::span<const Plateau> plateaus, double after_s, double before_s);

/// How far a track is from the true staircase once it has settled.
struct StaircaseErrors {
  /// One a step: mean of a plateau less mean of the one before it, less the true difference [m].
  std::vector<double> steps_m;
  /// One a settled sample: its height above the mean of the plateau before, less the true difference [m].
  /// What is off at any moment, noise included. Samples of the first plateau have no plateau before them.
  std::vector<double> samples_m;
};

/// Plateaus without a sample are left out.
StaircaseErrors staircase_errors(const HeightTrack& track, std::span<const Plateau> plateaus);

/// Median and standard deviation of |error|: the figures that the paper gives (for zero-mean normal errors of
/// sigma they are 0.674 and 0.603 sigma). NaN for no error.
struct ErrorFigures {
  std::size_t count = 0;
  double median_m = 0.0;
  double sd_m = 0.0;
};
ErrorFigures error_figures(std::span<const double> errors_m);

}  // namespace isobar
