// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sensitivity_study.hpp"

#include <algorithm>
#include <utility>

#include "core/calibration/height_difference.hpp"
#include "core/stamp.hpp"

namespace isobar::tools {

namespace {

// After four lags a first-order low-pass has 2 % of a step left: 0.5 mm of 3 cm.
constexpr double kSettledLags = 4.0;
// Default lag as a share of the shortest level, and its limits.
constexpr double kLagShare = 0.1;
constexpr double kMinLagS = 0.1;
constexpr double kMaxLagS = 3.0;

HeightTrack track_of(const FilteredPressure& moved, const FilteredPressure& standing, std::int64_t start_ns,
                     double air_temperature_k) {
  HeightSeries series = height_difference(moved, standing, air_temperature_k);
  HeightTrack track;
  track.heights_m = std::move(series.heights_m);
  track.times_s.reserve(series.stamps_ns.size());
  for (const std::int64_t stamp_ns : series.stamps_ns)
    track.times_s.push_back(seconds_between(start_ns, stamp_ns));
  return track;
}

double shortest_s(const std::vector<Plateau>& plateaus) {
  double shortest = plateaus.front().end_s - plateaus.front().begin_s;
  for (const Plateau& plateau : plateaus) shortest = std::min(shortest, plateau.end_s - plateau.begin_s);
  return shortest;
}

}  // namespace

HeightTrack raw_track(const BarometerPair& pair, double air_temperature_k) {
  return track_of(filter_log(pair.moved, 0.0), filter_log(pair.standing, 0.0), pair.moved.front().stamp_ns,
                  air_temperature_k);
}

SensorStudy study_pair(const BarometerPair& pair, std::vector<Plateau> plateaus,
                       const StudyOptions& options) {
  SensorStudy study;
  study.name = pair.name;
  study.plateaus = std::move(plateaus);
  study.raw = raw_track(pair, options.air_temperature_k);
  study.lag_s = options.lag_s.value_or(
      std::clamp(kLagShare * (shortest_s(study.plateaus) + 2.0 * options.settle_s), kMinLagS, kMaxLagS));
  const FilteredPressure moved = filter_log(pair.moved, study.lag_s);
  study.filtered = track_of(moved, filter_log(pair.standing, study.lag_s), pair.moved.front().stamp_ns,
                            options.air_temperature_k);
  study.sigma_pa = moved.sigma_pa;
  study.output_sigma_pa = moved.design.output_sigma_pa;
  study.raw_errors = staircase_errors(study.raw, study.plateaus);
  // With the delay subtracted from its stamp, the output reacts to a step one lag early and settles one lag
  // earlier.
  study.filtered_errors = staircase_errors(
      study.filtered, shortened(study.plateaus, (kSettledLags - 1.0) * study.lag_s, study.lag_s));
  return study;
}

SensorStudy study_pair(const BarometerPair& pair, const std::vector<double>& step_times_s,
                       const StudyOptions& options) {
  return study_pair(pair,
                    plateaus_between(raw_track(pair, options.air_temperature_k), step_times_s, options.step_m,
                                     options.settle_s, options.settle_s),
                    options);
}

}  // namespace isobar::tools
