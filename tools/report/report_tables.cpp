// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report_tables.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "tools/report/figure_rows.hpp"
#include "tools/report/svg.hpp"

namespace isobar::report {

namespace {

/// Lower is better: what the best method of a row has least of.
double rank_value(const FigureRow& row, const evaluation::MethodFigures& figures) {
  const double value = row.value(figures);
  if (row.larger_is_better) return -value;
  return row.is_signed ? std::abs(value) : value;
}

/// Whether this method's shown value is the best of the row; not if only one method took part or all are
/// equal.
bool is_best(const FigureRow& row, const evaluation::EvaluatedRun& run,
             const evaluation::EvaluatedMethod& method) {
  if (!row.is_ranked || run.methods.size() < 2) return false;
  double best = INFINITY;
  double worst = -INFINITY;
  for (const evaluation::EvaluatedMethod& other : run.methods) {
    const double rank = rank_value(row, other.evaluation.figures);
    if (!std::isfinite(rank)) continue;
    best = std::min(best, rank);
    worst = std::max(worst, rank);
  }
  return best < worst && rank_value(row, method.evaluation.figures) == best;
}

std::string cell(const std::string& text, std::string_view css_class = "") {
  const std::string attribute = css_class.empty() ? "" : " class=\"" + std::string(css_class) + "\"";
  return "<td" + attribute + ">" + escaped(text) + "</td>";
}

std::string table_head(const evaluation::EvaluatedRun& run, const std::string& first,
                       const std::string& second) {
  std::string html = "<div class=\"scroll\"><table>\n<thead><tr><th>" + escaped(first) + "</th><th>" +
                     escaped(second) + "</th>";
  for (const evaluation::EvaluatedMethod& method : run.methods)
    html += "<th>" + escaped(evaluation::display_name(method.name)) + "</th>";
  return html + "</tr></thead>\n<tbody>\n";
}

std::string verdict_row(const evaluation::EvaluatedRun& run) {
  std::string html = "<tr><td>Verdict</td><td></td>";
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    html += method.evaluation.figures.lost ? cell("lost", "lost") : cell("ok");
  }
  return html + "</tr>\n";
}

std::string definition(const std::string& term, const std::string& text) {
  return "<dt>" + escaped(term) + "</dt><dd>" + escaped(text) + "</dd>\n";
}

std::string ate_alignment_text(evaluation::Alignment alignment) {
  switch (alignment) {
    case evaluation::Alignment::kStart:
      return "after the same alignment at the start";
    case evaluation::Alignment::kYawTranslation:
      return "after the yaw and shift that fit best (Umeyama)";
    case evaluation::Alignment::kRigid:
      return "after the rotation and shift that fit best (Umeyama)";
  }
  return "";
}

}  // namespace

std::string run_summary(const evaluation::EvaluatedRun& run) {
  const double travelled_m = evaluation::travelled_distance_m(run.reference.trajectory.poses).back();
  return std::to_string(run.methods.size()) + (run.methods.size() == 1 ? " estimate" : " estimates") +
         " against the reference " + run.reference.source.string() + ": " + fixed(travelled_m, 1) + " m in " +
         fixed(run.reference.trajectory.duration_s(), 1) + " s.";
}

std::string figures_table(const evaluation::EvaluatedRun& run) {
  std::string html = table_head(run, "", "");
  std::string_view group;
  for (const FigureRow& row : figure_rows()) {
    if (group != row.group) {
      html += "<tr class=\"group\"><th colspan=\"" + std::to_string(run.methods.size() + 2) + "\">" +
              escaped(row.group) + "</th></tr>\n";
    }
    group = row.group;
    html += "<tr>" + cell(row.label) + cell(row.unit, "unit");
    for (const evaluation::EvaluatedMethod& method : run.methods) {
      html += cell(shown(row, method.evaluation.figures), is_best(row, run, method) ? "best" : "");
    }
    html += "</tr>\n";
  }
  return html + verdict_row(run) + "</tbody></table></div>\n";
}

std::string floors_table(const evaluation::EvaluatedRun& run) {
  const std::vector<double> levels = evaluation::floor_levels_m(run);
  if (levels.empty()) return "";
  std::string html =
      "<p class=\"before-table\">Mean of estimate minus reference [m] over the flat segments of each floor; "
      "in brackets the visit "
      "that is furthest off, where there was more than one.</p>\n" +
      table_head(run, "Floor at [m]", "");
  for (const double level_m : levels) {
    html += "<tr>" + cell(fixed_signed(level_m, 2)) + "<td></td>";
    for (const evaluation::EvaluatedMethod& method : run.methods) {
      const evaluation::FloorHeight* floor = evaluation::floor_at(method, level_m, run.options.floor_gap_m);
      std::string text = "\u2013";
      if (floor != nullptr) text = fixed_signed(floor->mean_error_m, 3);
      if (floor != nullptr && floor->visits > 1) text += " (" + fixed_signed(floor->worst_error_m, 3) + ")";
      html += cell(text);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string definitions(const evaluation::EvaluatedRun& run) {
  const evaluation::EvaluationOptions& options = run.options;
  std::string html = "<dl>\n";
  html +=
      definition("Alignment",
                 "The reference is interpolated at the estimate's stamps. The estimate is moved by a yaw and "
                 "a shift so that both agree in x, y, z and yaw at their first common pose.");
  html += definition(
      "Relative error on z",
      "|change of height of the estimate \u2212 that of the reference| over " +
          fixed(options.z_window.length_m, 0) +
          " m of travel, divided by that distance; windows start every " +
          fixed(options.z_window.start_step_m, 1) +
          " m and lie wholly in one flat segment. After Dubois et al., Under Pressure: Altimeter-Aided ICP "
          "for 3D Maps Consistency.");
  html += definition("ATE, absolute trajectory error", "Distance between estimate and reference, " +
                                                           ate_alignment_text(options.ate_alignment) + ".");
  html += definition("RPE, relative pose error",
                     "Error of the motion over " + fixed(options.pose_window.length_m, 0) +
                         " m of travel, divided by that distance (Sturm et al. 2012).");
  html +=
      definition("Time covered", "Share of the reference's time between poses of the estimate less than " +
                                     fixed(options.max_gap_s, 1) + " s apart.");
  html += definition("Verdict",
                     "Lost if less than " + fixed(100.0 * options.lost_below_coverage, 0) +
                         " % of the time is covered, or if the position is ever off by more than " +
                         fixed(options.lost_beyond_m, 0) + " m and " +
                         fixed(100.0 * options.lost_beyond_share_of_distance, 0) + " % of the distance.");
  return html + "</dl>\n";
}

}  // namespace isobar::report
