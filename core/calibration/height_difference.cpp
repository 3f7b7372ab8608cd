// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/height_difference.hpp"

#include <algorithm>
#include <cmath>

#include "core/altitude/hypsometry.hpp"
#include "core/altitude/pressure_filter.hpp"
#include "core/calibration/still_period.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

/// Linear interpolation, constant beyond the ends.
double interpolated(const FilteredPressure& series, std::int64_t stamp_ns) {
  const auto after = std::lower_bound(series.stamps_ns.begin(), series.stamps_ns.end(), stamp_ns);
  const auto i = static_cast<std::size_t>(after - series.stamps_ns.begin());
  if (i == 0) return series.pressures_pa.front();
  if (i == series.pressures_pa.size()) return series.pressures_pa.back();
  const double share = seconds_between(series.stamps_ns[i - 1], stamp_ns) /
                       seconds_between(series.stamps_ns[i - 1], series.stamps_ns[i]);
  return series.pressures_pa[i - 1] + share * (series.pressures_pa[i] - series.pressures_pa[i - 1]);
}

}  // namespace

FilteredPressure filter_log(std::span<const PressureSample> log, double lag_s) {
  FilteredPressure out;
  std::vector<double> pressures;
  pressures.reserve(log.size());
  for (const PressureSample& sample : log) pressures.push_back(sample.pressure_pa);
  out.sigma_pa = robust_sigma(pressures);
  out.interval_s =
      seconds_between(log.front().stamp_ns, log.back().stamp_ns) / static_cast<double>(log.size() - 1);
  if (lag_s > 0.0 && out.sigma_pa > 0.0) out.design = design_for_lag(out.sigma_pa, out.interval_s, lag_s);
  const bool unfiltered = out.design.gain >= 1.0;
  PressureFilter filter(out.design.walk_pa_sqrt_s);
  std::int64_t before_ns = log.front().stamp_ns;
  for (const PressureSample& sample : log) {
    double pressure_pa = sample.pressure_pa;
    std::int64_t stamp_ns = sample.stamp_ns;
    if (!unfiltered) {
      filter.add(pressure_pa, seconds_between(before_ns, stamp_ns), squared(out.sigma_pa));
      before_ns = stamp_ns;
      pressure_pa = filter.pressure_pa();
      stamp_ns -= std::llround(1e9 * filter.delay_s());
    }
    // While the filter fills its memory the delay grows, so stamps may repeat: keep the later output.
    if (!out.stamps_ns.empty() && stamp_ns <= out.stamps_ns.back()) {
      out.pressures_pa.back() = pressure_pa;
      continue;
    }
    out.stamps_ns.push_back(stamp_ns);
    out.pressures_pa.push_back(pressure_pa);
  }
  return out;
}

HeightSeries height_difference(const FilteredPressure& moved, const FilteredPressure& standing,
                               double air_temperature_k) {
  HeightSeries series;
  series.stamps_ns = moved.stamps_ns;
  series.heights_m.reserve(moved.pressures_pa.size());
  for (std::size_t i = 0; i < moved.stamps_ns.size(); ++i) {
    series.heights_m.push_back(hypsometric_height_m(interpolated(standing, moved.stamps_ns[i]),
                                                    moved.pressures_pa[i], air_temperature_k));
  }
  return series;
}

}  // namespace isobar
