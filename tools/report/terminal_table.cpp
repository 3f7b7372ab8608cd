// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/terminal_table.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/aligned_rows.hpp"
#include "tools/report/figure_rows.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

constexpr double kNone = evaluation::MethodFigures::kNone;

/// ASCII hyphens for minus sign and dash: scripts read the terminal's table.
std::string plain(std::string text) {
  for (const std::string_view sign : {"\u2212", "\u2013"}) {
    for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at)) {
      text.replace(at, sign.size(), "-");
    }
  }
  return text;
}

void print_figures(std::FILE* out, const evaluation::EvaluatedRun& run) {
  std::vector<Cells> table{{"method"}, {""}};
  for (const FigureRow& row : figure_rows()) {
    if (row.heading == nullptr) continue;
    table[0].emplace_back(row.heading);
    table[1].emplace_back("[" + std::string(row.unit) + "]");
  }
  table[0].emplace_back("verdict");
  table[1].emplace_back("");
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    Cells cells{evaluation::display_name(method.name)};
    for (const FigureRow& row : figure_rows()) {
      if (row.heading != nullptr) cells.push_back(plain(shown(row, method.evaluation.figures)));
    }
    cells.emplace_back(verdict_word(method.evaluation.figures.verdict.kind));
    table.push_back(std::move(cells));
  }
  std::fputs(aligned_rows(table).c_str(), out);
}

/// Shares of poses within the 95 % ellipsoid; prints nothing for runs without covariances.
void print_consistency(std::FILE* out, const evaluation::EvaluatedRun& run) {
  std::vector<Cells> table{{"method", "NEES/6", "all", "position", "orientation", "x", "y", "z", "roll",
                            "pitch", "yaw", "silently wrong"}};
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    const evaluation::ConsistencyFigures& figures = method.evaluation.figures.consistency;
    if (figures.poses == 0) continue;
    Cells cells{evaluation::display_name(method.name), plain(fixed(figures.nees, 2))};
    for (const double share :
         {figures.within_95, figures.within_95_position, figures.within_95_orientation}) {
      cells.push_back(plain(fixed(100.0 * share, 1)));
    }
    for (const double share : figures.within_95_component) cells.push_back(plain(fixed(100.0 * share, 1)));
    cells.push_back(fixed(figures.longest_silent_s, 1) + " s");
    table.push_back(std::move(cells));
  }
  if (table.size() == 1) return;
  std::fprintf(out, "\nErrors within the 95 %% ellipsoid of their covariance [%% of poses]\n");
  std::fputs(aligned_rows(table).c_str(), out);
}

/// Shares of the map's points; prints nothing without a map or without known surfaces.
void print_map(std::FILE* out, const evaluation::EvaluatedRun& run) {
  std::vector<Cells> table{{"method", "within 5 cm", "beyond 20 cm"}};
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    const evaluation::MapFigures& figures = method.evaluation.figures.map;
    if (std::isnan(figures.within_5_cm)) continue;
    table.push_back({evaluation::display_name(method.name), fixed(100.0 * figures.within_5_cm, 2),
                     fixed(100.0 * figures.beyond_20_cm, 2)});
  }
  if (table.size() == 1) return;
  std::fprintf(out, "\nPoints of the map by their distance from the nearest true surface [%% of points]\n");
  std::fputs(aligned_rows(table).c_str(), out);
}

/// One column per floor; prints nothing without flat segments.
void print_floors(std::FILE* out, const evaluation::EvaluatedRun& run) {
  const std::vector<double> floors = evaluation::floor_levels_m(run);
  if (floors.empty()) return;
  std::fprintf(out, "\nMean height error of each floor [m]\n");
  std::vector<Cells> table{{"floor at"}};
  for (const double level_m : floors) table[0].push_back(fixed(level_m, 2) + " m");
  table[0].insert(table[0].end(), {"after 1 min: mean", "largest"});
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    Cells cells{evaluation::display_name(method.name)};
    for (const double level_m : floors) {
      const evaluation::FloorHeight* floor = evaluation::floor_at(method, level_m, run.options.floor_gap_m);
      cells.push_back(plain(fixed_signed(floor == nullptr ? kNone : floor->mean_error_m, 3)));
    }
    cells.push_back(plain(fixed(method.evaluation.figures.settled_floors_mean_m, 3)));
    cells.push_back(plain(fixed(method.evaluation.figures.settled_floors_worst_m, 3)));
    table.push_back(std::move(cells));
  }
  std::fputs(aligned_rows(table).c_str(), out);
}

}  // namespace

void print_table(std::FILE* out, const evaluation::EvaluatedRun& run) {
  const double travelled_m = run.methods.empty() ? 0.0 : run.methods.front().evaluation.figures.travelled_m;
  std::fprintf(out, "%s: %.1f m in %.1f s\n\n", run.reference.source.c_str(), travelled_m,
               run.reference.trajectory.duration_s());
  if (run.methods.empty()) return;
  print_figures(out, run);
  print_floors(out, run);
  print_consistency(out, run);
  print_map(out, run);
  if (!run.notes.empty()) std::fprintf(out, "\n");
  for (const std::string& note : run.notes) std::fprintf(out, "Note: %s\n", note.c_str());
}

}  // namespace isobar::report
