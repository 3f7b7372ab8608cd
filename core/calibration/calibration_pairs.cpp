// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/calibration_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"
#include "core/statistics/distribution.hpp"

namespace isobar {
namespace {

// Spike: deviation from the median above this many median absolute deviations, far beyond any noise.
constexpr double kSpikeDeviations = 20.0;
// Smallest deviation of a spike [Pa]: the temperature error of poor sensors is as large.
constexpr double kLeastSpikePa = 200.0;

double median_interval_s(std::span<const PressureSample> samples) {
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    intervals_s.push_back(seconds_between(samples[k - 1].stamp_ns, samples[k].stamp_ns));
  }
  return intervals_s.empty() ? 0.0 : median(std::move(intervals_s));
}

}  // namespace

std::vector<CalibrationPair> pair_with_reference(std::span<const PressureSample> sensor,
                                                 const PressureSeries& reference, double shift_s,
                                                 PairingCounts& counts) {
  const double interval_s = median_interval_s(sensor);
  const double width_s = 2.0 * reference.interval_s() <= interval_s ? interval_s : 0.0;
  const bool has_thermometer = std::any_of(sensor.begin(), sensor.end(), [](const PressureSample& sample) {
    return std::isfinite(sample.temperature_c);
  });
  std::vector<CalibrationPair> pairs;
  for (const PressureSample& sample : sensor) {
    const double time_s = PressureSeries::time_s(sample.stamp_ns) + shift_s;
    const double reference_pa = reference.mean_pa(time_s, width_s);
    if (!std::isfinite(reference_pa)) {
      ++counts.without_reference;
    } else if (has_thermometer && !std::isfinite(sample.temperature_c)) {
      ++counts.without_temperature;
    } else {
      pairs.push_back({reference_pa, sample.pressure_pa, has_thermometer ? sample.temperature_c : 0.0});
    }
  }
  counts.paired += pairs.size();
  return pairs;
}

std::size_t drop_spikes(std::vector<CalibrationRecording>& recordings) {
  const auto difference = [](const CalibrationPair& pair) { return pair.reference_pa - pair.pressure_pa; };
  std::vector<double> values;
  for (const CalibrationRecording& recording : recordings) {
    for (const CalibrationPair& pair : recording.pairs) values.push_back(difference(pair));
  }
  if (values.empty()) return 0;
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  const double limit = std::max(kLeastSpikePa, kSpikeDeviations * median(std::move(values)));
  std::size_t dropped = 0;
  for (CalibrationRecording& recording : recordings) {
    dropped += std::erase_if(recording.pairs, [&](const CalibrationPair& pair) {
      return std::abs(difference(pair) - middle) > limit;
    });
  }
  return dropped;
}

}  // namespace isobar
