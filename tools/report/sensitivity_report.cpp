// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sensitivity_report.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/box_plot.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/line_chart.hpp"

namespace isobar::report {

namespace {

constexpr double kCm = 100.0;
constexpr const char* kColours[] = {"#2563eb", "#b45309", "#15803d", "#7c3aed"};  // NOLINT: a table

/// A track in centimetres above its mean on the first plateau.
Series centimetres(const HeightTrack& track, const Plateau& first, const std::string& name,
                   const Stroke& stroke) {
  double sum_m = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < track.times_s.size(); ++i) {
    if (track.times_s[i] < first.begin_s || track.times_s[i] > first.end_s) continue;
    sum_m += track.heights_m[i];
    count += 1.0;
  }
  const double zero_m = (count > 0.0 ? sum_m / count : track.heights_m.front()) - first.true_height_m;
  Series series{name, stroke, track.times_s, {}};
  for (const double height_m : track.heights_m) series.y.push_back(kCm * (height_m - zero_m));
  return series;
}

Picture height_picture(const HeightPicture& picture, const std::string& id) {
  LineChart chart;
  chart.x_label = "time [s]";
  chart.y_label = "height above the first level [cm]";
  chart.height = 340.0;
  chart.id = id;
  const Plateau& first = picture.plateaus.front();
  chart.series.push_back(centimetres(picture.raw, first, "from sample to sample", {"#bfdbfe", 0.7}));
  chart.series.push_back(centimetres(picture.filtered, first,
                                     "low-pass, lag of " + fixed(picture.lag_s, 2) + " s taken off",
                                     {"#1d4ed8", 1.6}));
  Series truth{"true", {"#dc2626", 1.8}, {}, {}, true};
  for (const Plateau& plateau : picture.plateaus) {
    truth.x.insert(truth.x.end(), {plateau.begin_s, plateau.end_s});
    truth.y.insert(truth.y.end(), {kCm * plateau.true_height_m, kCm * plateau.true_height_m});
  }
  chart.series.push_back(std::move(truth));
  return draw(chart);
}

Picture error_picture(const SensitivityExperiment& experiment) {
  BoxPlot plot;
  plot.x_label = "|steady-state error| [cm]";
  plot.unit = "cm";
  std::vector<std::string> sensors;
  for (const ErrorRow& row : experiment.rows) {
    auto sensor = std::find(sensors.begin(), sensors.end(), row.sensor);
    if (sensor == sensors.end()) sensor = sensors.insert(sensors.end(), row.sensor);
    std::vector<double> sizes;
    for (const double error_m : row.errors_m) sizes.push_back(kCm * std::abs(error_m));
    plot.rows.push_back({row.sensor + ", " + row_name(row),
                         kColours[static_cast<std::size_t>(sensor - sensors.begin()) % std::size(kColours)],
                         summarize(std::move(sizes))});
  }
  return draw(plot);
}

std::string figures_table(const SensitivityExperiment& experiment) {
  const bool many = !experiment.rows.empty() && experiment.rows.front().runs.size() > 1;
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>sensor</th><th>errors</th><th>median [cm]</th><th>sd "
      "[cm]</th>";
  if (many) html += "<th>median of the worst run</th><th>sd of the worst run</th>";
  html += "</tr></thead><tbody>\n";
  const auto cell = [](double value_m) { return "<td>" + fixed(kCm * value_m, 2) + "</td>"; };
  for (const ErrorRow& row : experiment.rows) {
    const OverRuns median = over_runs(row, &ErrorFigures::median_m);
    const OverRuns sd = over_runs(row, &ErrorFigures::sd_m);
    html += "<tr><td>" + escaped(row.sensor) + "</td><td class=\"unit\">" + escaped(row_name(row)) + "</td>" +
            cell(median.median_m) + cell(sd.median_m);
    if (many) html += cell(median.worst_m) + cell(sd.worst_m);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
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
  std::string html = "<h1>" + escaped(report.title) + "</h1>\n<p class=\"lead\">" +
                     escaped(report.description) + "</p>\n<div class=\"command\">" + escaped(report.command) +
                     "</div>\n";
  int number = 0;
  for (const SensitivityExperiment& experiment : report.experiments) {
    html += heading(experiment.title) + "<p>" + escaped(experiment.caption) + "</p>\n";
    for (const HeightPicture& picture : experiment.pictures) {
      html += figure(height_picture(picture, "height" + std::to_string(number++)),
                     picture.sensor + ": height against time",
                     picture.sensor + ", moved above standing. Red: the true staircase, where it counts.");
    }
    html +=
        figure(error_picture(experiment), "Box plot of the steady-state errors",
               "Thick line: median; box: quartiles; whiskers: 5th and 95th percentiles. An error is the "
               "height gained since the level before, less the true step: of every settled sample (what is "
               "off at any moment), and of each level's mean (what a robot that waits can reach).") +
        figures_table(experiment);
  }
  return html_page(report.title, html);
}

}  // namespace isobar::report
