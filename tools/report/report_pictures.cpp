// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/report/box_plot.hpp"
#include "tools/report/histogram.hpp"
#include "tools/report/line_chart.hpp"
#include "tools/report/method_style.hpp"

namespace isobar::report {

namespace {

using evaluation::PosePair;

constexpr double kPercent = 100.0;

double height_error_m(const PosePair& pair) {
  return pair.estimate.position_m.z() - pair.reference.position_m.z();
}

Series method_series(const evaluation::EvaluatedRun& run, const evaluation::EvaluatedMethod& method,
                     double (*value)(const PosePair&)) {
  Series series{evaluation::display_name(method.name),
                method_stroke(run, method),
                {},
                {},
                &method == &main_method(run)};
  for (const PosePair& pair : method.evaluation.pairs) {
    series.x.push_back(pair.distance_m);
    series.y.push_back(value(pair));
  }
  return series;
}

Series reference_series(const evaluation::EvaluatedRun& run) {
  const auto& poses = run.reference.trajectory.poses;
  // Wide, so that it stays visible below an estimate that coincides with it.
  Series series{"Reference", {"#9ca3af", 6.0}, evaluation::travelled_distance_m(poses), {}};
  for (const evaluation::StampedPose& pose : poses) series.y.push_back(pose.position_m.z());
  return series;
}

/// The altimeter's heights in the reference's frame, at the poses with the same stamp; empty without
/// altimeter.
Series altimeter_series(const evaluation::EvaluatedMethod& method) {
  Series series{"Altimeter", kAltimeterStroke, {}, {}};
  const double start_m = method.evaluation.T_reference_estimate.translation().z();
  auto row = method.status.begin();
  for (const PosePair& pair : method.evaluation.pairs) {
    while (row != method.status.end() && row->stamp_ns < pair.stamp_ns) ++row;
    if (row == method.status.end()) break;
    if (row->stamp_ns != pair.stamp_ns || !std::isfinite(row->altimeter_height_m)) continue;
    series.x.push_back(pair.distance_m);
    series.y.push_back(start_m + row->altimeter_height_m);
  }
  return series;
}

/// The altimeter of the main method, else of the first method that has one.
Series altimeter_series(const evaluation::EvaluatedRun& run) {
  Series series = altimeter_series(main_method(run));
  for (auto method = run.methods.begin(); method != run.methods.end() && series.x.empty(); ++method) {
    series = altimeter_series(*method);
  }
  return series;
}

/// The recording's segments over the travelled distance.
std::vector<Band> segment_bands(const evaluation::EvaluatedRun& run) {
  const auto& poses = run.reference.trajectory.poses;
  const std::vector<double> distance_m = evaluation::travelled_distance_m(poses);
  const auto at = [&](std::int64_t stamp_ns) {
    const auto pose = std::lower_bound(poses.begin(), poses.end(), stamp_ns,
                                       [](const auto& p, std::int64_t stamp) { return p.stamp_ns < stamp; });
    return distance_m[static_cast<std::size_t>(std::min(pose, poses.end() - 1) - poses.begin())];
  };
  std::vector<Band> bands;
  for (const evaluation::Segment& segment : run.reference.segments) {
    bands.push_back(
        {at(segment.start_ns), at(segment.end_ns), segment.label, segment.label == evaluation::kFlatLabel});
  }
  return bands;
}

Range travelled_range(const evaluation::EvaluatedRun& run) {
  return {0.0, std::max(0.1, evaluation::travelled_distance_m(run.reference.trajectory.poses).back())};
}

/// An empty chart over the travelled distance, with the recording's segments.
LineChart chart_along_way(const evaluation::EvaluatedRun& run, const std::string& y_label,
                          const PictureSize& size, const std::string& id) {
  LineChart chart;
  chart.x_label = "travelled distance [m]";
  chart.y_label = y_label;
  chart.width = size.width;
  chart.height = size.height;
  chart.id = id;
  chart.bands = segment_bands(run);
  chart.x_range = travelled_range(run);
  return chart;
}

double largest_height_error_m(const evaluation::EvaluatedMethod& method) {
  return std::abs(method.evaluation.figures.largest_height_error_m);
}

}  // namespace

const evaluation::EvaluatedMethod& main_method(const evaluation::EvaluatedRun& run) {
  // The default method, else the paper's.
  for (const std::string_view name : {"adaptive", "3dof"}) {
    for (const evaluation::EvaluatedMethod& method : run.methods) {
      if (method.name == name) return method;
    }
  }
  return run.methods.front();
}

const evaluation::EvaluatedMethod* contrast_method(const evaluation::EvaluatedRun& run, bool needs_map) {
  const evaluation::EvaluatedMethod* worst = nullptr;
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    if (&method == &main_method(run) || (needs_map && method.map_points.empty())) continue;
    if (worst == nullptr || largest_height_error_m(method) > largest_height_error_m(*worst)) worst = &method;
  }
  return worst;
}

Picture z_rpe_picture(const evaluation::EvaluatedRun& run, double width) {
  BoxPlot plot;
  plot.x_label = "relative error on z over 5 m of travel [%]";
  plot.unit = "%";
  plot.width = width;
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    Distribution d = method.evaluation.figures.z_rpe;
    for (double* value : {&d.p05, &d.q25, &d.median, &d.q75, &d.p95, &d.p99, &d.max}) *value *= kPercent;
    plot.rows.push_back({evaluation::display_name(method.name), method_stroke(run, method).colour, d});
  }
  return draw(plot);
}

Picture height_picture(const evaluation::EvaluatedRun& run, const PictureSize& size, const std::string& id) {
  LineChart chart = chart_along_way(run, "height [m]", size, id);
  chart.min_y_width = 1.0;
  chart.series.push_back(reference_series(run));
  Series altimeter = altimeter_series(run);
  if (!altimeter.x.empty()) chart.series.push_back(std::move(altimeter));
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    chart.series.push_back(
        method_series(run, method, [](const PosePair& p) { return p.estimate.position_m.z(); }));
  }
  return draw(chart);
}

Picture height_error_picture(const evaluation::EvaluatedRun& run, const PictureSize& size,
                             std::optional<double> limit_m, const std::string& id) {
  LineChart chart = chart_along_way(run, "height error [m]", size, id);
  chart.zero_line = true;
  if (limit_m) chart.y_range = Range{-*limit_m, *limit_m};
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    chart.series.push_back(method_series(run, method, height_error_m));
  }
  return draw(chart);
}

std::optional<double> close_up_limit_m(const evaluation::EvaluatedRun& run) {
  // Ratio of largest errors from which the main method is a flat line in the full picture.
  constexpr double kTooFlat = 5.0;
  const evaluation::EvaluatedMethod* contrast = contrast_method(run, false);
  const double main_m = std::max(0.02, largest_height_error_m(main_method(run)));
  if (contrast == nullptr || largest_height_error_m(*contrast) < kTooFlat * main_m) return std::nullopt;
  return 1.5 * main_m;
}

std::optional<Picture> scan_time_picture(const evaluation::EvaluatedRun& run, double width) {
  HistogramChart chart;
  chart.x_label = "time per scan [ms]";
  chart.unit = "ms";
  chart.width = width;
  bool any = false;
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    HistogramChart::Row row{evaluation::display_name(method.name), method_stroke(run, method).colour, {}};
    for (const evaluation::StatusRow& status : method.status) row.values.push_back(status.scan_ms);
    if (row.values.empty()) continue;
    any = any || std::any_of(row.values.begin(), row.values.end(), [](double v) { return std::isfinite(v); });
    chart.rows.push_back(std::move(row));
  }
  if (!any) return std::nullopt;
  return draw(chart);
}

}  // namespace isobar::report
