// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report_tables.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "tools/report/figure_rows.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

/// Key for ranking the methods of a row; the lowest is best.
double rank_value(const FigureRow& row, const evaluation::MethodFigures& figures) {
  const double value = row.value(figures);
  if (row.larger_is_better) return -value;
  return row.is_signed ? std::abs(value) : value;
}

/// Whether this method is the best of the row; false with one method, or when all are equal.
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

std::vector<std::string> table_head(const evaluation::EvaluatedRun& run, std::vector<std::string> first) {
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    first.push_back(evaluation::display_name(method.name));
  }
  return first;
}

std::vector<TableCell> verdict_row(const evaluation::EvaluatedRun& run) {
  std::vector<TableCell> row{{"Verdict"}, {""}};
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    const evaluation::Verdict& verdict = method.evaluation.figures.verdict;
    const std::string reason = verdict.ok() ? "" : ": " + verdict.reason;
    row.push_back({verdict_word(verdict.kind) + reason, verdict.ok() ? "" : "lost"});
  }
  return row;
}

std::string floor_text(const evaluation::FloorHeight* floor) {
  if (floor == nullptr) return "\u2013";
  const std::string mean = fixed_signed(floor->mean_error_m, 3);
  return floor->visits > 1 ? mean + " (" + fixed_signed(floor->worst_error_m, 3) + ")" : mean;
}

std::string definition(const std::string& term, const std::string& text) {
  return "<dt>" + escaped(term) + "</dt><dd>" + escaped(text) + "</dd>\n";
}

std::string ate_alignment_text(evaluation::Alignment alignment) {
  switch (alignment) {
    case evaluation::Alignment::kStart:
    case evaluation::Alignment::kStartOfPath:
      return "after the alignment above";
    case evaluation::Alignment::kYawTranslation:
      return "after the best-fitting yaw and translation (Umeyama 1991)";
    case evaluation::Alignment::kRigid:
      return "after the best-fitting rotation and translation (Umeyama 1991)";
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
  std::vector<std::vector<TableCell>> rows;
  std::string_view group;
  for (const FigureRow& figure : figure_rows()) {
    if (group != figure.group) rows.push_back({{figure.group, "group", run.methods.size() + 2}});
    group = figure.group;
    std::vector<TableCell>& row = rows.emplace_back();
    row = {{figure.label}, {figure.unit, "unit"}};
    for (const evaluation::EvaluatedMethod& method : run.methods) {
      row.push_back({shown(figure, method.evaluation.figures), is_best(figure, run, method) ? "best" : ""});
    }
  }
  rows.push_back(verdict_row(run));
  return html_table(table_head(run, {"", ""}), rows);
}

std::string floors_table(const evaluation::EvaluatedRun& run) {
  std::vector<std::vector<TableCell>> rows;
  for (const double level_m : evaluation::floor_levels_m(run)) {
    std::vector<TableCell>& row = rows.emplace_back();
    row.push_back({fixed_signed(level_m, 2)});
    for (const evaluation::EvaluatedMethod& method : run.methods) {
      row.push_back({floor_text(evaluation::floor_at(method, level_m, run.options.floor_gap_m))});
    }
  }
  if (rows.empty()) return "";
  return "<p class=\"before-table\">Mean of estimate minus reference [m] over the flat segments of each "
         "floor; in "
         "brackets the visit with the largest error, where there are several.</p>\n" +
         html_table(table_head(run, {"Floor at [m]"}), rows);
}

std::string definitions(const evaluation::EvaluatedRun& run) {
  const evaluation::EvaluationOptions& options = run.options;
  std::string html = "<dl>\n";
  html += definition(
      "Alignment",
      "The reference is interpolated at the estimate's stamps. The estimate is moved by a yaw and a "
      "translation so that both agree in x, y, z and yaw at their first common pose.");
  html += definition(
      "Relative error on z",
      "|height change of the estimate \u2212 height change of the reference| over " +
          fixed(options.z_window.length_m, 0) +
          " m of travel, divided by that distance; windows start every " +
          fixed(options.z_window.start_step_m, 1) +
          " m and lie in one flat segment. From Dubois et al., Under Pressure: Altimeter-Aided ICP for 3D "
          "Maps Consistency.");
  html += definition("ATE, absolute trajectory error", "Distance between estimate and reference, " +
                                                           ate_alignment_text(options.ate_alignment) + ".");
  html += definition("RPE, relative pose error",
                     "Error of the motion over " + fixed(options.pose_window.length_m, 0) +
                         " m of travel, divided by that distance (Sturm et al. 2012).");
  html += definition("Floors after the first minute", "Mean height error of each floor without the first " +
                                                          fixed(options.settling_s, 0) +
                                                          " s: mean and largest of their magnitudes.");
  html += definition(
      "Covariance",
      "NEES: e\u1d40 C\u207b\u00b9 e of the error e and the estimate's covariance C of x, y, z, roll, pitch, "
      "yaw, "
      "over its expectation 6; an honest covariance has 1, and 95 % of the poses within the 95 % ellipsoid. "
      "Silently wrong: called registered, yet off by more than " +
          fixed(evaluation::ConsistencyFigures::kWrongM, 1) +
          " m in position and outside of its 99.99 % ellipsoid.");
  html +=
      definition("Map",
                 "Points of the map after the alignment above, by their distance from the nearest surface of "
                 "the simulated world that does not move (surfaces.stl).");
  html += definition(
      "Time covered",
      "Share of the reference's time between consecutive poses of the estimate no further apart than " +
          (options.max_gap_s ? fixed(*options.max_gap_s, 1) + " s."
                             : fixed(evaluation::kUsualGapS, 1) +
                                   " s, or 1.5 of its usual intervals where these are longer."));
  html += definition("Verdict",
                     "Lost if the position error ever exceeds both " + fixed(options.verdict.beyond_m, 0) +
                         " m and " + fixed(100.0 * options.verdict.beyond_share_of_distance, 0) +
                         " % of the distance; else incomplete if less than " +
                         fixed(100.0 * options.verdict.least_coverage, 0) + " % of the time is covered.");
  return html + "</dl>\n";
}

}  // namespace isobar::report
