// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/noise_report.hpp"

#include "tools/report/html_page.hpp"
#include "tools/report/line_chart.hpp"

namespace isobar::report {

namespace {

std::string tiles(const NoiseReport& report) {
  const SensorNoise& noise = report.noise;
  std::string html = "<ul class=\"tiles\">\n";
  html += tile("White noise of a sample, 1 sigma", fixed(noise.sigma_pa, 3) + " Pa",
               fixed(report.cm_per_pa * noise.sigma_pa, 1) + " cm; from the Allan deviation " +
                   fixed(noise.allan_sigma_pa(), 3) + " Pa");
  html += tile("Bias instability", fixed(noise.parts.bias_instability, 3) + " Pa",
               fixed(report.cm_per_pa * noise.parts.bias_instability, 2) + " cm");
  html += tile("Random walk", fixed(noise.parts.walk, 4) + " Pa/√s",
               "trend " + fixed(3600.0 * noise.parts.ramp, 0) + " Pa an hour");
  html += tile("After a low-pass of " + fixed(report.chosen.delay_s, 2) + " s",
               fixed(report.chosen.output_sigma_pa, 3) + " Pa",
               fixed(report.cm_per_pa * report.chosen.output_sigma_pa, 2) + " cm of white noise");
  return html + "</ul>\n";
}

Picture series_picture(const NoiseReport& report) {
  LineChart chart;
  chart.x_label = "time [s]";
  chart.y_label = "pressure − first [Pa]";
  chart.height = 260.0;
  chart.id = "series";
  Series series{"", {"#2563eb", 1.0}, report.times_s, report.pressures_pa};
  for (double& pressure : series.y) pressure -= report.pressures_pa.front();
  chart.series.push_back(std::move(series));
  const StillPeriod& still = report.noise.still;
  chart.bands.push_back({report.times_s[still.begin], report.times_s[still.end - 1], "still"});
  return draw(chart);
}

Picture allan_picture(const SensorNoise& noise) {
  LineChart chart;
  chart.x_label = "averaging time [s]";
  chart.y_label = "Allan deviation [Pa]";
  chart.height = 420.0;
  chart.id = "allan";
  chart.is_logarithmic = true;
  Series measured{"measured", {"#2563eb", 2.4}, {}, {}, true};
  Series above{"measured ± 1 sigma", {"#93c5fd", 1.0}, {}, {}};
  Series below{"", {"#93c5fd", 1.0}, {}, {}};
  Series model{"white + instability + walk + trend", {"#b45309", 1.6, "6 4"}, {}, {}};
  for (const AllanPoint& point : noise.allan) {
    if (point.uncertainty > 0.5 || !(point.deviation > 0.0)) continue;
    for (Series* series : {&measured, &above, &below, &model}) series->x.push_back(point.tau_s);
    measured.y.push_back(point.deviation);
    above.y.push_back(point.deviation * (1.0 + point.uncertainty));
    below.y.push_back(point.deviation * (1.0 - point.uncertainty));
    model.y.push_back(modelled_deviation(noise.parts, point));
  }
  chart.series = {std::move(above), std::move(below), std::move(model), std::move(measured)};
  return draw(chart);
}

std::string designs_table(const NoiseReport& report) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>lag [s]</th><th>bandwidth [Hz]</th><th>gain</th>"
      "<th>walk [Pa/√s]</th><th>noise left [Pa]</th><th>[cm]</th></tr></thead><tbody>\n";
  for (const FilterDesign& design : report.designs) {
    html += "<tr><td>" + fixed(design.delay_s, 2) + "</td><td>" + fixed(design.bandwidth_hz, 3) +
            "</td><td>" + fixed(design.gain, 4) + "</td><td>" + fixed(design.walk_pa_sqrt_s, 4) +
            "</td><td>" + fixed(design.output_sigma_pa, 4) + "</td><td>" +
            fixed(report.cm_per_pa * design.output_sigma_pa, 2) + "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string render_noise_report(const NoiseReport& report) {
  std::string html = "<h1>" + escaped(report.title) + "</h1>\n<p class=\"lead\">" + escaped(report.source) +
                     "</p>\n<div class=\"command\">" + escaped(report.command) + "</div>\n" + tiles(report);
  html += heading("The samples") + figure(series_picture(report), "Pressure against time",
                                          "All samples. Shaded: the still period that the figures are from.");
  html += heading("Allan deviation") +
          figure(allan_picture(report.noise), "Allan deviation against averaging time",
                 "Overlapping. White noise falls with the square root of the averaging time, a random walk "
                 "rises with it, a steady trend of the weather rises in proportion. Points that are less "
                 "certain than 50 % are left out.");
  html += heading("Settings of the low-pass") +
          "<p>Lag: how far the output is behind a pressure that changes steadily; it is known, and taken off "
          "the output's time stamp. Bandwidth: motion slower than this passes.</p>\n" +
          designs_table(report);
  return html_page(report.title, html);
}

}  // namespace isobar::report
