// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/report/report_pictures.hpp"
#include "tools/report/report_tables.hpp"
#include "tools/report/svg.hpp"
#include "tools/report/text_file.hpp"

namespace isobar::report {

namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #1f2937;
  font: 16px/1.55 system-ui, "Segoe UI", Roboto, "DejaVu Sans", Helvetica, Arial, sans-serif; }
main { max-width: 1104px; margin: 0 auto; padding: 40px 32px 64px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 8px; letter-spacing: -0.01em; }
h2 { font-size: 20px; margin: 48px 0 6px; }
p { margin: 6px 0; max-width: 78ch; }
.lead { color: #374151; font-size: 17px; }
.command { margin: 16px 0 0; padding: 10px 14px; background: #f3f4f6; border-radius: 6px; font: 13.5px/1.5 ui-monospace,
  "DejaVu Sans Mono", Menlo, Consolas, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
.tiles { display: flex; flex-wrap: wrap; gap: 14px; margin: 26px 0 0; padding: 0; list-style: none; }
.tiles li { flex: 1 1 200px; border: 1px solid #d1d5db; border-radius: 8px; padding: 12px 16px; }
.tiles .label { font-size: 13.5px; color: #4b5563; }
.tiles .value { font-size: 26px; font-weight: 600; font-variant-numeric: tabular-nums; line-height: 1.35; }
.tiles .more { font-size: 13.5px; color: #4b5563; }
figure { margin: 14px 0 0; break-inside: avoid; }
figure svg { display: block; max-width: 100%; height: auto; }
figcaption { font-size: 14px; color: #4b5563; margin-top: 4px; max-width: 92ch; }
.pair { display: flex; flex-wrap: wrap; gap: 14px; }
.pair > div { flex: 1 1 100%; }
.pair > .half { flex: 1 1 480px; }
.pair h3 { font-size: 15px; margin: 10px 0 4px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 14.5px; font-variant-numeric: tabular-nums; margin-top: 12px; }
th, td { padding: 5px 14px 5px 0; text-align: right; border-bottom: 1px solid #e5e7eb; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid #6b7280; vertical-align: bottom; }
tr.group th { padding-top: 16px; text-align: left; color: #374151; border-bottom: 1px solid #9ca3af; }
td.unit { text-align: left; color: #4b5563; }
td.best { font-weight: 700; }
td.lost { color: #b91c1c; font-weight: 700; }
.notes li { margin: 3px 0; max-width: 92ch; }
dl { max-width: 92ch; font-size: 15px; } dt { font-weight: 600; margin-top: 10px; } dd { margin: 0; }
@page { size: A4; margin: 14mm; }
@media print { main { padding: 0; max-width: none; } h2, .before-table { break-after: avoid; } body { font-size: 11pt; }
  table { font-size: 8pt; } th, td { padding: 3px 9px 3px 0; } th { white-space: normal; } .scroll { overflow: visible; }
  tr { break-inside: avoid; } .tiles { gap: 8px; } .tiles li { flex-basis: 22%; padding: 8px 10px; }
  .tiles .value { font-size: 20px; } }
)css";

std::string figure(const Picture& picture, const std::string& title, const std::string& caption) {
  return "<figure>\n" + picture.svg(title) + "<figcaption>" + escaped(caption) + "</figcaption>\n</figure>\n";
}

std::string heading(const std::string& text) { return "<h2>" + escaped(text) + "</h2>\n"; }

std::string tile(const std::string& label, const std::string& value, const std::string& more) {
  return "<li><div class=\"label\">" + escaped(label) + "</div><div class=\"value\">" + escaped(value) +
         "</div><div class=\"more\">" + escaped(more) + "</div></li>\n";
}

std::string z_rpe_comparison(const EvaluatedRun& run) {
  const double ours = main_method(run).evaluation.figures.z_rpe.median;
  for (const EvaluatedMethod& method : run.methods) {
    const double other = method.evaluation.figures.z_rpe.median;
    if (method.name != "4dof" || &method == &main_method(run) || !(other > 0.0) || !std::isfinite(ours))
      continue;
    const double change = 100.0 * (ours / other - 1.0);
    return fixed(std::abs(change), 0) + " % " + (change < 0.0 ? "less" : "more") + " than 4-DOF's " +
           fixed(100.0 * other, 2) + " %";
  }
  return "95th percentile " + fixed(100.0 * main_method(run).evaluation.figures.z_rpe.p95, 2) + " %";
}

/// What the main method reached, in four figures.
std::string tiles(const EvaluatedRun& run) {
  const EvaluatedMethod& method = main_method(run);
  const evaluation::MethodFigures& figures = method.evaluation.figures;
  std::vector<double> times_ms;
  for (const StatusRow& row : method.status) {
    if (std::isfinite(row.scan_ms)) times_ms.push_back(row.scan_ms);
  }
  const evaluation::Distribution time = evaluation::summarize(std::move(times_ms));
  std::string html = "<ul class=\"tiles\">\n";
  html += tile(display_name(method.name) + ": error on z, median",
               fixed(100.0 * figures.z_rpe.median, 2) + " %", z_rpe_comparison(run));
  html += tile("Largest height error", fixed_signed(figures.largest_height_error_m, 2) + " m",
               "at the end " + fixed_signed(figures.final_height_error_m, 2) + " m");
  html +=
      tile("Position error, rms", fixed(figures.ate_rms_m, 2) + " m",
           fixed(100.0 * figures.ate_share, 2) + " % of " + fixed(figures.travelled_m, 1) + " m travelled");
  if (time.count > 0) {
    html += tile("Time per scan, median", fixed(time.median, 1) + " ms",
                 "99th percentile " + fixed(time.p99, 1) + " ms");
  }
  return html + "</ul>\n";
}

std::string z_rpe_section(const EvaluatedRun& run) {
  const bool whole_run = main_method(run).evaluation.figures.whole_run_as_flat;
  return heading("Relative error on z") +
         figure(z_rpe_picture(run, 1040.0), "Box plot of the relative error on z by method",
                std::string("Height gained in 5 m of travel, estimate against reference, over ") +
                    (whole_run ? "the whole run" : "the flat segments") +
                    ". Thick line: median; box: quartiles; whiskers: 5th and 95th percentiles.");
}

std::string height_section(const EvaluatedRun& run) {
  std::string html =
      heading("Height along the way") +
      figure(height_picture(run, {1040.0, 380.0}, "height"), "Height against travelled distance",
             "Heights after the start poses were laid over each other." +
                 std::string(floor_levels_m(run).empty() ? "" : " Shaded: flat segments.")) +
      heading("Height error along the way") +
      figure(height_error_picture(run, {1040.0, 320.0}, std::nullopt, "error"),
             "Height error against travelled distance", "Estimate minus reference.");
  if (const std::optional<double> limit_m = close_up_limit_m(run)) {
    html += figure(
        height_error_picture(run, {1040.0, 280.0}, limit_m, "closeup"),
        "Height error against travelled distance, close up",
        "The same, close up: " + display_name(main_method(run).name) + " in full, the others cut off.");
  }
  return html;
}

std::string side_section(const EvaluatedRun& run) {
  const std::vector<SideView> views = side_view_pictures(run);
  if (views.empty()) return "";
  std::string html = heading("The map from the side") + "<figure><div class=\"pair\">\n";
  for (const SideView& view : views) {
    html += std::string(view.is_half ? "<div class=\"half\">" : "<div>") + "<h3>" + escaped(view.method) +
            "</h3>\n" + view.picture.svg("Side elevation of the map of " + view.method) + "</div>\n";
  }
  return html +
         "</div><figcaption>Points of the map, darker where there are more, with the path of the estimate "
         "and of the "
         "reference. Red: mean height of the reference on each floor, with the estimate's mean error there."
         "</figcaption></figure>\n";
}

std::string top_section(const EvaluatedRun& run) {
  const bool has_map = !main_method(run).map_points.empty();
  const std::string what = has_map ? "Map of " + display_name(main_method(run).name) + " and paths" : "Paths";
  return heading(has_map ? "The map from above" : "The paths from above") +
         figure(top_view_picture(run), what + " from above",
                what + ", to scale." +
                    (floor_levels_m(run).size() > 1 ? " All floors lie over each other." : ""));
}

std::string time_section(const EvaluatedRun& run) {
  const std::optional<Picture> picture = scan_time_picture(run, 1040.0);
  if (!picture) return "";
  return heading("Time per scan") +
         figure(*picture, "Histogram of the time per scan by method",
                "From deskew to solution. Full line: median; dashed: 99th percentile. "
                "Longer times are counted in the last bar.");
}

std::string notes_section(const EvaluatedRun& run) {
  if (run.notes.empty()) return "";
  std::string html = heading("Notes") + "<ul class=\"notes\">\n";
  for (const std::string& note : run.notes) html += "<li>" + escaped(note) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace

std::string render_report(const ReportInput& input) {
  const EvaluatedRun& run = input.run;
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(input.title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<main>\n<h1>" +
      escaped(input.title) + "</h1>\n";
  if (!input.description.empty()) html += "<p class=\"lead\">" + escaped(input.description) + "</p>\n";
  html += "<p>" + escaped(run_summary(run)) + "</p>\n";
  if (!input.command.empty()) html += "<div class=\"command\">" + escaped(input.command) + "</div>\n";
  html += tiles(run) + z_rpe_section(run) + height_section(run) + side_section(run) + top_section(run) +
          time_section(run) + heading("All figures") + figures_table(run);
  const std::string floors = floors_table(run);
  if (!floors.empty()) html += heading("Height of each floor") + floors;
  return html + notes_section(run) + heading("How these figures are made") + definitions(run) +
         "</main>\n</body>\n</html>\n";
}

void write_report(const std::filesystem::path& file, const ReportInput& input) {
  write_text_file(file, render_report(input));
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
