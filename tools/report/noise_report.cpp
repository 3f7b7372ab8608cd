// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/noise_report.hpp"

#include <utility>
#include <vector>

#include "tools/report/curve_chart.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

constexpr double kMaxUncertainty = 0.5;  // relative; of an averaging time with few averages

std::string tiles(const NoiseReport& report) {
  const SensorNoise& noise = report.noise;
  const auto cm = [&](double pressure_pa, int decimals) {
    return fixed(report.cm_per_pa * pressure_pa, decimals) + " cm";
  };
  return tile_row(
      {{"White noise of a sample, 1 sigma", fixed(noise.sigma_pa, 3) + " Pa",
        cm(noise.sigma_pa, 1) + "; from the Allan deviation " + fixed(noise.allan_sigma_pa(), 3) + " Pa"},
       {"Bias instability", fixed(noise.parts.bias_instability, 3) + " Pa",
        cm(noise.parts.bias_instability, 2)},
       {"Random walk", fixed(noise.parts.walk, 4) + " Pa/√s",
        "trend " + fixed(3600.0 * noise.parts.ramp, 0) + " Pa/h"},
       {"After a low-pass with " + fixed(report.chosen.delay_s, 2) + " s of lag",
        fixed(report.chosen.output_sigma_pa, 3) + " Pa",
        cm(report.chosen.output_sigma_pa, 2) + " of white noise"}});
}

CurveChart series_chart(const NoiseReport& report) {
  CurveChart chart;
  chart.x_label = "time [s]";
  chart.y_label = "pressure − first [Pa]";
  chart.x_unit = "s";
  chart.y_unit = "Pa";
  Curve series{"", {"#2f7fd6", 1.0}, report.times_s, report.pressures_pa};
  for (double& pressure : series.y) pressure -= report.pressures_pa.front();
  chart.curves.push_back(std::move(series));
  const StillPeriod& still = report.noise.still;
  chart.spans.push_back({report.times_s[still.begin], report.times_s[still.end - 1], "still"});
  return chart;
}

CurveChart allan_chart(const SensorNoise& noise) {
  CurveChart chart;
  chart.x_label = "averaging time [s]";
  chart.y_label = "Allan deviation [Pa]";
  chart.x_unit = "s";
  chart.y_unit = "Pa";
  chart.y_decimals = 4;
  chart.is_logarithmic = true;
  Curve measured{"measured, with 1 sigma", {"#2f7fd6", 2.4}, {}, {}};
  Curve model{"white + instability + walk + trend", {"#c8641b", 1.6, "6 4"}, {}, {}};
  Area sigma{"#2f7fd640", {}, {}, {}};
  for (const AllanPoint& point : noise.allan) {
    if (point.uncertainty > kMaxUncertainty || !(point.deviation > 0.0)) continue;
    for (std::vector<double>* x : {&measured.x, &model.x, &sigma.x}) x->push_back(point.tau_s);
    measured.y.push_back(point.deviation);
    sigma.high.push_back(point.deviation * (1.0 + point.uncertainty));
    sigma.low.push_back(point.deviation * (1.0 - point.uncertainty));
    model.y.push_back(modelled_deviation(noise.parts, point));
  }
  chart.curves = {std::move(model), std::move(measured)};
  chart.areas = {std::move(sigma)};
  return chart;
}

std::string designs_table(const NoiseReport& report) {
  std::vector<std::vector<TableCell>> rows;
  for (const FilterDesign& design : report.designs) {
    rows.push_back({{fixed(design.delay_s, 2)},
                    {fixed(design.bandwidth_hz, 3)},
                    {fixed(design.gain, 4)},
                    {fixed(design.walk_pa_sqrt_s, 4)},
                    {fixed(design.output_sigma_pa, 4)},
                    {fixed(report.cm_per_pa * design.output_sigma_pa, 2)}});
  }
  return html_table({"lag [s]", "bandwidth [Hz]", "gain", "walk [Pa/√s]", "noise left [Pa]", "[cm]"}, rows);
}

}  // namespace

std::string render_noise_report(const NoiseReport& report) {
  std::string html = page_head(report.title, report.source, report.command) + tiles(report);
  html += heading("Samples") +
          chart_figure(chart_json(series_chart(report)), "Pressure against time",
                       "All samples. Shaded: the still period that the figures are taken from.");
  html += heading("Allan deviation") +
          chart_figure(
              chart_json(allan_chart(report.noise)), "Allan deviation against averaging time",
              "Overlapping Allan deviation. White noise falls with the square root of the averaging time, a "
              "random walk rises with it, a steady trend of the weather rises in proportion. Points with an "
              "uncertainty above 50 % are left out.");
  html += heading("Settings of the low-pass") +
          paragraph(
              "Lag: delay of the output behind a steadily changing pressure; it is known, and subtracted "
              "from the output's time stamp. Bandwidth: slower motion passes.") +
          designs_table(report);
  return html_page(report.title, html);
}

}  // namespace isobar::report
