// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report_charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/statistics/distribution.hpp"
#include "tools/report/method_style.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

using evaluation::EvaluatedMethod;
using evaluation::EvaluatedRun;
using evaluation::PosePair;

constexpr double kPercent = 100.0;
constexpr std::size_t kBins = 80;

/// The altimeter's heights at the poses with the same stamp.
Curve altimeter_curve(const EvaluatedMethod& method) {
  Curve curve{"Altimeter", kAltimeterStroke, {}, {}};
  const double start_m = method.evaluation.T_reference_estimate.translation().z();
  auto row = method.status.begin();
  for (const PosePair& pair : method.evaluation.pairs) {
    while (row != method.status.end() && row->stamp_ns < pair.stamp_ns) ++row;
    if (row == method.status.end()) break;
    if (row->stamp_ns != pair.stamp_ns || !std::isfinite(row->altimeter_height_m)) continue;
    curve.x.push_back(pair.distance_m);
    curve.y.push_back(start_m + row->altimeter_height_m);
  }
  return curve;
}

std::vector<double> ascending_times_ms(const EvaluatedMethod& method) {
  std::vector<double> times_ms;
  for (const evaluation::StatusRow& status : method.status) {
    if (std::isfinite(status.scan_ms)) times_ms.push_back(status.scan_ms);
  }
  std::sort(times_ms.begin(), times_ms.end());
  return times_ms;
}

/// Share of the values in each of kBins bins from 0 to `end` [%].
Curve histogram(const std::vector<double>& values, double end) {
  Curve curve;
  curve.is_stepped = true;
  const double width = end / static_cast<double>(kBins);
  std::vector<std::size_t> counts(kBins, 0);
  for (const double value : values) {
    const double bin = std::clamp(value / width, 0.0, static_cast<double>(kBins - 1));
    ++counts[static_cast<std::size_t>(bin)];
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    curve.x.push_back(width * static_cast<double>(bin));
    curve.y.push_back(kPercent * static_cast<double>(counts[bin]) / static_cast<double>(values.size()));
  }
  curve.x.push_back(end);
  curve.y.push_back(0.0);
  return curve;
}

}  // namespace

const EvaluatedMethod& main_method(const EvaluatedRun& run) {
  // The default method, else the paper's.
  for (const std::string_view name : {"adaptive", "3dof"}) {
    for (const EvaluatedMethod& method : run.methods) {
      if (method.name == name) return method;
    }
  }
  return run.methods.front();
}

BoxChart z_rpe_chart(const EvaluatedRun& run) {
  BoxChart chart;
  chart.x_label = "relative error on z over 5 m of travel [%]";
  chart.unit = "%";
  for (const EvaluatedMethod& method : run.methods) {
    Distribution d = method.evaluation.figures.z_rpe;
    for (double* value : {&d.p05, &d.q25, &d.median, &d.q75, &d.p95, &d.p99, &d.max}) *value *= kPercent;
    chart.rows.push_back({evaluation::display_name(method.name), method_stroke(run, method).colour, d});
  }
  return chart;
}

Curve altimeter_curve(const EvaluatedRun& run) {
  Curve curve = altimeter_curve(main_method(run));
  for (auto method = run.methods.begin(); method != run.methods.end() && curve.x.empty(); ++method) {
    curve = altimeter_curve(*method);
  }
  return curve;
}

std::optional<CurveChart> scan_time_chart(const EvaluatedRun& run) {
  CurveChart chart;
  chart.x_label = "time per scan [ms]";
  chart.y_label = "scans [%]";
  chart.x_unit = "ms";
  chart.y_unit = "%";
  double end_ms = 0.0;
  for (const EvaluatedMethod& method : run.methods)
    end_ms = std::max(end_ms, 1.3 * quantile(ascending_times_ms(method), 0.99));
  if (!(end_ms > 0.0)) return std::nullopt;
  double highest = 0.0;
  for (const EvaluatedMethod& method : run.methods) {
    const std::vector<double> times_ms = ascending_times_ms(method);
    if (times_ms.empty()) continue;
    Curve curve = histogram(times_ms, end_ms);
    curve.name = evaluation::display_name(method.name) + ": median " + fixed(quantile(times_ms, 0.5), 1) +
                 " ms, p99 " + fixed(quantile(times_ms, 0.99), 1) + " ms";
    curve.stroke = method_stroke(run, method);
    highest = std::max(highest, *std::max_element(curve.y.begin(), curve.y.end()));
    chart.curves.push_back(std::move(curve));
  }
  chart.y_range = {0.0, 1.06 * highest};
  return chart;
}

}  // namespace isobar::report
