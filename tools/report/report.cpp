// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/report/altimeter_section.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/number_text.hpp"
#include "tools/report/provenance.hpp"
#include "tools/report/report_charts.hpp"
#include "tools/report/report_data.hpp"
#include "tools/report/report_tables.hpp"

namespace isobar::report {

namespace {

std::string z_rpe_comparison(const evaluation::EvaluatedRun& run) {
  const double ours = main_method(run).evaluation.figures.z_rpe.median;
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    const double other = method.evaluation.figures.z_rpe.median;
    if (method.name != "4dof" || &method == &main_method(run) || !(other > 0.0) || !std::isfinite(ours))
      continue;
    const double change = 100.0 * (ours / other - 1.0);
    return fixed(std::abs(change), 0) + " % " + (change < 0.0 ? "less" : "more") + " than 4-DOF's " +
           fixed(100.0 * other, 2) + " %";
  }
  return "95th percentile " + fixed(100.0 * main_method(run).evaluation.figures.z_rpe.p95, 2) + " %";
}

/// Four figures of the main method.
std::string tiles(const evaluation::EvaluatedRun& run) {
  const evaluation::EvaluatedMethod& method = main_method(run);
  const evaluation::MethodFigures& figures = method.evaluation.figures;
  std::vector<double> times_ms;
  for (const evaluation::StatusRow& row : method.status) {
    if (std::isfinite(row.scan_ms)) times_ms.push_back(row.scan_ms);
  }
  const Distribution time = summarize(std::move(times_ms));
  std::vector<Tile> tiles{
      {evaluation::display_name(method.name) + ": relative error on z, median",
       fixed(100.0 * figures.z_rpe.median, 2) + " %", z_rpe_comparison(run)},
      {"Largest height error", fixed_signed(figures.largest_height_error_m, 2) + " m",
       "at the end " + fixed_signed(figures.final_height_error_m, 2) + " m"},
      {"Position error (ATE), rms", fixed(figures.ate_rms_m, 2) + " m",
       fixed(100.0 * figures.ate_share, 2) + " % of " + fixed(figures.travelled_m, 1) + " m travelled"}};
  if (time.count > 0) {
    tiles.push_back({"Time per scan, median", fixed(time.median, 1) + " ms",
                     "99th percentile " + fixed(time.p99, 1) + " ms"});
  }
  return tile_row(tiles);
}

std::string z_rpe_section(const evaluation::EvaluatedRun& run) {
  const bool whole_run = main_method(run).evaluation.figures.whole_run_as_flat;
  return heading("Relative error on z") +
         chart_figure(chart_json(z_rpe_chart(run)), "Box plot of the relative error on z by method",
                      std::string("Height gained in 5 m of travel, estimate against reference, over ") +
                          (whole_run ? "the whole run" : "the flat segments") +
                          ". Thick line: median; box: quartiles; whiskers: 5th and 95th percentiles.");
}

/// The mounts that the run has found, as its mounts.toml.
std::string mounts_section(const evaluation::EvaluatedRun& run) {
  const std::string& mounts = main_method(run).mounts;
  return mounts.empty()
             ? ""
             : heading("Mounts found") + "<pre role=\"region\" aria-label=\"Mounts found\" tabindex=\"0\">" +
                   escaped(mounts) + "</pre>\n";
}

std::string time_section(const evaluation::EvaluatedRun& run) {
  const std::optional<CurveChart> chart = scan_time_chart(run);
  if (!chart) return "";
  return heading("Time per scan") +
         chart_figure(
             chart_json(*chart), "Histogram of the time per scan by method",
             "From deskewing to the solved pose. Times beyond the axis are counted in its last bin.");
}

}  // namespace

std::string render_report(const ReportInput& input) {
  const evaluation::EvaluatedRun& run = input.run;
  std::string html = page_head(input.title, input.description, input.command) + paragraph(run_summary(run)) +
                     paragraph(provenance_line()) + tiles(run) + way_and_map(run) + z_rpe_section(run) +
                     altimeter_section(run) + mounts_section(run) + time_section(run) +
                     heading("All figures") + figures_table(run) + settings_section(run);
  const std::string floors = floors_table(run);
  if (!floors.empty()) html += heading("Height of each floor") + floors;
  if (!run.notes.empty()) html += heading("Notes") + bullet_list(run.notes);
  return html_page(input.title, html + heading("Definitions") + definitions(run), PageScript::kReport);
}

}  // namespace isobar::report
