// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/altimeter_section.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/stamp.hpp"
#include "tools/report/curve_chart.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/number_text.hpp"
#include "tools/report/report_charts.hpp"

namespace isobar::report {

namespace {

using evaluation::EvaluatedMethod;
using evaluation::StatusRow;

// Shorter faults on the picture's axis would be invisible.
constexpr double kLeastBandS = 1.0;

bool estimates_bias(const EvaluatedMethod& method) {
  return std::any_of(method.status.begin(), method.status.end(),
                     [](const StatusRow& row) { return std::isfinite(row.altimeter_bias_m); });
}

const EvaluatedMethod* method_with_bias(const evaluation::EvaluatedRun& run) {
  if (estimates_bias(main_method(run))) return &main_method(run);
  const auto found = std::find_if(run.methods.begin(), run.methods.end(), estimates_bias);
  return found == run.methods.end() ? nullptr : &*found;
}

double time_s(const EvaluatedMethod& method, const StatusRow& row) {
  return seconds_between(method.status.front().stamp_ns, row.stamp_ns);
}

/// Why the altimeter is marked at this pose; empty: it is not.
std::string fault_of(const StatusRow& row) {
  const bool drifts = !row.altimeter_drifts.empty() && row.altimeter_drifts != "none";
  if (!drifts) return row.altimeter_faulty ? "faulty" : "";
  return row.altimeter_drifts == "robot"          ? "robot drifts"
         : row.altimeter_drifts == "base_station" ? "base drifts"
                                                  : "drifts";
}

std::vector<Span> faults_of(const EvaluatedMethod& method) {
  std::vector<Span> bands;
  std::string last;
  for (const StatusRow& row : method.status) {
    const double t = time_s(method, row);
    const std::string fault = fault_of(row);
    if (!fault.empty() && fault != last) bands.push_back({t, t + kLeastBandS, fault});
    if (!fault.empty()) bands.back().to = std::max(bands.back().to, t);
    last = fault;
  }
  return bands;
}

CurveChart bias_chart(const EvaluatedMethod& method) {
  CurveChart chart;
  chart.x_label = "time [s]";
  chart.y_label = "altimeter minus map [m]";
  chart.x_unit = "s";
  chart.y_unit = "m";
  chart.spans = faults_of(method);
  Curve innovation{"Innovation", {"#d55e00a0", 0.8}, {}, {}};
  Curve bias{"Bias, with 1 sigma", {"#2f7fd6", 2.0}, {}, {}};
  Area sigma{"#2f7fd640", {}, {}, {}};
  for (const StatusRow& row : method.status) {
    const double t = time_s(method, row);
    innovation.x.push_back(t);
    innovation.y.push_back(row.altimeter_innovation_m);
    bias.x.push_back(t);
    bias.y.push_back(row.altimeter_bias_m);
    sigma.x.push_back(t);
    sigma.low.push_back(row.altimeter_bias_m - row.altimeter_bias_sd_m);
    sigma.high.push_back(row.altimeter_bias_m + row.altimeter_bias_sd_m);
  }
  chart.curves = {std::move(innovation), std::move(bias)};
  chart.areas = {std::move(sigma)};
  return chart;
}

std::string largest_innovation(const EvaluatedMethod& method) {
  const StatusRow* largest = nullptr;
  for (const StatusRow& row : method.status) {
    if (!std::isfinite(row.altimeter_innovation_m)) continue;
    if (largest == nullptr ||
        std::abs(row.altimeter_innovation_m) > std::abs(largest->altimeter_innovation_m)) {
      largest = &row;
    }
  }
  return "Largest innovation " + fixed_signed(largest->altimeter_innovation_m, 2) + " m at " +
         fixed(time_s(method, *largest), 1) + " s. ";
}

/// Coefficient of the airflow at the end of the run; empty where nothing was learnt of it.
std::string airflow_text(const EvaluatedMethod& method) {
  const StatusRow& last = method.status.back();
  if (!(last.airflow_sd_s2_m > 0.0)) return "";
  return "The robot's own wind shifts the altimeter by " + fixed_signed(1e3 * last.airflow_s2_m, 1) +
         " mm per (m/s)², 1 sigma " + fixed(1e3 * last.airflow_sd_s2_m, 1) + ". ";
}

std::string faults_text(const EvaluatedMethod& method) {
  const std::vector<Span> bands = faults_of(method);
  if (bands.empty()) return "No fault of a barometer was seen.";
  std::string text = "Shaded: ";
  for (const Span& band : bands) {
    text += (&band == bands.data() ? "" : ", ") + band.label + " since " + fixed(band.from, 1) + " s";
    text += " until " + fixed(band.to, 1) + " s";
  }
  return text + ".";
}

}  // namespace

std::string altimeter_section(const evaluation::EvaluatedRun& run) {
  const EvaluatedMethod* method = method_with_bias(run);
  if (method == nullptr) return "";
  return heading("Altimeter against the map") +
         chart_figure(
             chart_json(bias_chart(*method)), "Bias of the altimeter against time",
             "Estimated bias of the altimeter of " + evaluation::display_name(method->name) +
                 ": ventilated zones, doors, weather, airflow, drifts of a barometer. The height does not "
                 "follow it. " +
                 largest_innovation(*method) + airflow_text(*method) + faults_text(*method));
}

}  // namespace isobar::report
