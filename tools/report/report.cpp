// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/report/altimeter_section.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/provenance.hpp"
#include "tools/report/report_data.hpp"
#include "tools/report/report_pictures.hpp"
#include "tools/report/report_tables.hpp"
#include "tools/report/svg.hpp"

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
         figure(z_rpe_picture(run, 1040.0), "Box plot of the relative error on z by method",
                std::string("Height gained in 5 m of travel, estimate against reference, over ") +
                    (whole_run ? "the whole run" : "the flat segments") +
                    ". Thick line: median; box: quartiles; whiskers: 5th and 95th percentiles.");
}

std::string height_section(const evaluation::EvaluatedRun& run) {
  std::string html =
      heading("Height along the way") +
      figure(height_picture(run, {1040.0, 380.0}, "height"), "Height against travelled distance",
             "Estimates moved so that all start poses coincide." +
                 std::string(evaluation::floor_levels_m(run).empty() ? "" : " Shaded: flat segments.")) +
      heading("Height error along the way") +
      figure(height_error_picture(run, {1040.0, 320.0}, std::nullopt, "error"),
             "Height error against travelled distance", "Estimate minus reference.");
  if (const std::optional<double> limit_m = close_up_limit_m(run)) {
    html += figure(height_error_picture(run, {1040.0, 280.0}, limit_m, "closeup"),
                   "Height error against travelled distance, close up",
                   "Close-up: " + evaluation::display_name(main_method(run).name) +
                       " in full, the other methods clipped.");
  }
  return html;
}

std::string side_section(const evaluation::EvaluatedRun& run) {
  const std::vector<SideView> views = side_view_pictures(run);
  if (views.empty()) return "";
  std::string html = heading("The map from the side") + "<figure tabindex=\"0\"><div class=\"pair\">\n";
  for (const SideView& view : views) {
    html += std::string(view.is_half ? "<div class=\"half\">" : "<div>") + "<h3>" + escaped(view.method) +
            "</h3>\n" + view.picture.svg("Side elevation of the map of " + view.method) + "</div>\n";
  }
  return html +
         "</div><figcaption>Points of the map, darker where denser, with the paths of estimate and "
         "reference. Red: "
         "mean height of each floor in the reference, with the estimate's mean error."
         "</figcaption></figure>\n";
}

std::string top_section(const evaluation::EvaluatedRun& run) {
  const bool has_map = !main_method(run).map_points.empty();
  const std::string what =
      has_map ? "Map of " + evaluation::display_name(main_method(run).name) + " and paths" : "Paths";
  return heading(has_map ? "The map from above" : "The paths from above") +
         figure(
             top_view_picture(run), what + " from above",
             what + ", to scale." +
                 (evaluation::floor_levels_m(run).size() > 1 ? " All floors are drawn on top of each other."
                                                             : ""));
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
  const std::optional<Picture> picture = scan_time_picture(run, 1040.0);
  if (!picture) return "";
  return heading("Time per scan") + figure(*picture, "Histogram of the time per scan by method",
                                           "From deskewing to the solved pose. Solid line: median; dashed: "
                                           "99th percentile. Times beyond the "
                                           "axis are counted in the last bar.");
}

}  // namespace

std::string render_report(const ReportInput& input) {
  const evaluation::EvaluatedRun& run = input.run;
  std::string html = page_head(input.title, input.description, input.command) + paragraph(run_summary(run)) +
                     paragraph(provenance_line()) + tiles(run) +
                     live_parts(run, height_section(run) + side_section(run) + top_section(run)) +
                     z_rpe_section(run) + altimeter_section(run) + mounts_section(run) + time_section(run) +
                     heading("All figures") + figures_table(run) + settings_section(run);
  const std::string floors = floors_table(run);
  if (!floors.empty()) html += heading("Height of each floor") + floors;
  if (!run.notes.empty()) html += heading("Notes") + bullet_list(run.notes);
  return html_page(input.title, html + heading("Definitions") + definitions(run));
}

std::string render_overview_svg(const ReportInput& input) {
  constexpr double kWidth = 1040.0;
  constexpr double kMargin = 20.0;
  constexpr double kHeadingHeight = 34.0;
  const Picture boxes = z_rpe_picture(input.run, kWidth);
  const Picture heights = height_picture(input.run, {kWidth, 340.0}, "overview");
  Picture page(kWidth + 2.0 * kMargin,
               boxes.height() + heights.height() + 2.0 * kHeadingHeight + 3.0 * kMargin);
  page.rect({0.0, 0.0, page.width(), page.height()}, "#ffffff");
  const TextStyle style{17.0, "#111827", "start", true};
  double y = kMargin;
  page.text({kMargin, y + 16.0}, "Relative error on z by method", style);
  page.place(boxes, {kMargin, y + kHeadingHeight});
  y += kHeadingHeight + boxes.height() + kMargin;
  page.text({kMargin, y + 16.0}, "Height along the way", style);
  page.place(heights, {kMargin, y + kHeadingHeight});
  return page.svg(input.title);
}

}  // namespace isobar::report
