// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sensitivity_report.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/box_chart.hpp"
#include "tools/report/curve_chart.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

constexpr double kCmPerM = 100.0;
constexpr const char* kColours[] = {"#2f7fd6", "#c8641b", "#1b9a62", "#9a63d8"};  // NOLINT: a table

/// A track in centimetres above the first level: its mean there equals the level's true height.
Curve centimetres(const HeightTrack& track, const Plateau& first, const std::string& name,
                  const Stroke& stroke) {
  double sum_m = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < track.times_s.size(); ++i) {
    if (track.times_s[i] < first.begin_s || track.times_s[i] > first.end_s) continue;
    sum_m += track.heights_m[i];
    count += 1.0;
  }
  const double zero_m = (count > 0.0 ? sum_m / count : track.heights_m.front()) - first.true_height_m;
  Curve series{name, stroke, track.times_s, {}};
  for (const double height_m : track.heights_m) series.y.push_back(kCmPerM * (height_m - zero_m));
  return series;
}

CurveChart height_chart(const HeightPicture& picture) {
  CurveChart chart;
  chart.x_label = "time [s]";
  chart.y_label = "height above the first level [cm]";
  chart.x_unit = "s";
  chart.y_unit = "cm";
  const Plateau& first = picture.plateaus.front();
  chart.curves.push_back(centimetres(picture.raw, first, "from sample to sample", {"#2f7fd670", 0.7}));
  chart.curves.push_back(centimetres(picture.filtered, first,
                                     "low-pass, lag of " + fixed(picture.lag_s, 2) + " s taken off",
                                     {"#2f7fd6", 1.8}));
  Curve truth{"true", {"#e0453a", 1.8}, {}, {}};
  for (const Plateau& plateau : picture.plateaus) {
    truth.x.insert(truth.x.end(), {plateau.begin_s, plateau.end_s});
    truth.y.insert(truth.y.end(), {kCmPerM * plateau.true_height_m, kCmPerM * plateau.true_height_m});
  }
  chart.curves.push_back(std::move(truth));
  return chart;
}

BoxChart error_chart(const SensitivityExperiment& experiment) {
  BoxChart chart;
  chart.x_label = "|steady-state error| [cm]";
  chart.unit = "cm";
  std::vector<std::string> sensors;
  for (const ErrorRow& row : experiment.rows) {
    auto sensor = std::find(sensors.begin(), sensors.end(), row.sensor);
    if (sensor == sensors.end()) sensor = sensors.insert(sensors.end(), row.sensor);
    std::vector<double> sizes;
    for (const double error_m : row.errors_m) sizes.push_back(kCmPerM * std::abs(error_m));
    chart.rows.push_back({row.sensor + ", " + row_name(row),
                          kColours[static_cast<std::size_t>(sensor - sensors.begin()) % std::size(kColours)],
                          summarize(std::move(sizes))});
  }
  return chart;
}

std::string figures_table(const SensitivityExperiment& experiment) {
  const bool many = !experiment.rows.empty() && experiment.rows.front().runs.size() > 1;
  std::vector<std::string> head{"sensor", "errors", "median [cm]", "sd [cm]"};
  if (many) head.insert(head.end(), {"median of the worst run", "sd of the worst run"});
  const auto cell = [](double value_m) { return TableCell{fixed(kCmPerM * value_m, 2)}; };
  std::vector<std::vector<TableCell>> rows;
  for (const ErrorRow& row : experiment.rows) {
    const OverRuns median = over_runs(row, &ErrorFigures::median_m);
    const OverRuns sd = over_runs(row, &ErrorFigures::sd_m);
    rows.push_back({{row.sensor}, {row_name(row), "unit"}, cell(median.median_m), cell(sd.median_m)});
    if (many) rows.back().insert(rows.back().end(), {cell(median.worst_m), cell(sd.worst_m)});
  }
  return html_table(head, rows);
}

}  // namespace

OverRuns over_runs(const ErrorRow& row, double ErrorFigures::*figure) {
  std::vector<double> values;
  for (const ErrorFigures& run : row.runs) values.push_back(run.*figure);
  const Distribution distribution = summarize(std::move(values));
  return {distribution.median, distribution.max};
}

std::string row_name(const ErrorRow& row) {
  return std::string(row.filtered ? "filtered" : "unfiltered") +
         (row.plateau_means ? ", means of levels" : ", every sample");
}

std::string render_sensitivity_report(const SensitivityReport& report) {
  std::string html = page_head(report.title, report.description, report.command);
  for (const SensitivityExperiment& experiment : report.experiments) {
    html += heading(experiment.title) + paragraph(experiment.caption);
    for (const HeightPicture& picture : experiment.pictures) {
      html += chart_figure(
          chart_json(height_chart(picture)), picture.sensor + ": height against time",
          picture.sensor +
              ", moved sensor above standing sensor. Red: the true height, where it is evaluated.");
    }
    html +=
        chart_figure(
            chart_json(error_chart(experiment)), "Box plot of the steady-state errors",
            "Thick line: median; box: quartiles; whiskers: 5th and 95th percentiles. Error: height gained "
            "since the previous level, minus the true step. Of every settled sample: the error at any "
            "moment; of the mean of each level: the error of a robot that waits.") +
        figures_table(experiment);
  }
  return html_page(report.title, html);
}

}  // namespace isobar::report
