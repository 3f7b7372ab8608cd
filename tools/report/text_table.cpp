// SPDX-License-Identifier: BSD-3-Clause
// The terminal's table and the JSON file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/aligned_rows.hpp"
#include "tools/report/evaluated_run.hpp"
#include "tools/report/figure_rows.hpp"
#include "tools/report/svg.hpp"

namespace isobar::report {

namespace {

constexpr double kNone = evaluation::MethodFigures::kNone;

/// Minus sign and dash as plain hyphens: other programs read the terminal's table too.
std::string plain(std::string text) {
  for (const std::string_view sign : {"\u2212", "\u2013"}) {
    for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at)) {
      text.replace(at, sign.size(), "-");
    }
  }
  return text;
}

void print_figures(std::FILE* out, const EvaluatedRun& run) {
  std::vector<Cells> table{{"method"}, {""}};
  for (const FigureRow& row : figure_rows()) {
    if (row.heading == nullptr) continue;
    table[0].emplace_back(row.heading);
    table[1].emplace_back("[" + std::string(row.unit) + "]");
  }
  table[0].emplace_back("verdict");
  table[1].emplace_back("");
  for (const EvaluatedMethod& method : run.methods) {
    Cells cells{display_name(method.name)};
    for (const FigureRow& row : figure_rows()) {
      if (row.heading != nullptr) cells.push_back(plain(shown(row, method.evaluation.figures)));
    }
    cells.emplace_back(method.evaluation.figures.lost ? "LOST" : "ok");
    table.push_back(std::move(cells));
  }
  std::fputs(aligned_rows(table).c_str(), out);
}

/// One column a floor; nothing without flat segments.
void print_floors(std::FILE* out, const EvaluatedRun& run) {
  const std::vector<double> floors = floor_levels_m(run);
  if (floors.empty()) return;
  std::fprintf(out, "\nMean height error of each floor [m]\n");
  std::vector<Cells> table{{"floor at"}};
  for (const double level_m : floors) table[0].push_back(fixed(level_m, 2) + " m");
  for (const EvaluatedMethod& method : run.methods) {
    Cells cells{display_name(method.name)};
    for (const double level_m : floors) {
      const evaluation::FloorHeight* floor = floor_at(method, level_m, run.options.floor_gap_m);
      cells.push_back(plain(fixed_signed(floor == nullptr ? kNone : floor->mean_error_m, 3)));
    }
    table.push_back(std::move(cells));
  }
  std::fputs(aligned_rows(table).c_str(), out);
}

std::string json_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      std::array<char, 8> code{};
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
      result += code.data();
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

/// Degrees where the key says so, the stored value else.
double json_value(const FigureRow& row, const evaluation::MethodFigures& figures) {
  const bool is_share = std::string_view(row.unit).starts_with('%');
  return row.value(figures) * (is_share ? 1.0 : row.scale);
}

std::string method_json(const EvaluatedMethod& method) {
  const evaluation::MethodFigures& figures = method.evaluation.figures;
  std::string text = "    {\"name\": " + json_text(method.name) +
                     ", \"source\": " + json_text(method.source.string()) +
                     ", \"lost\": " + (figures.lost ? "true" : "false") +
                     ", \"z_rpe_over_whole_run\": " + (figures.whole_run_as_flat ? "true" : "false");
  for (const FigureRow& row : figure_rows()) {
    text += ",\n     \"" + std::string(row.key) + "\": " + json_number(json_value(row, figures));
  }
  text += ",\n     \"floors\": [";
  for (std::size_t i = 0; i < figures.floors.size(); ++i) {
    const evaluation::FloorHeight& floor = figures.floors[i];
    text += std::string(i == 0 ? "" : ", ") + "{\"reference_m\": " + json_number(floor.reference_m) +
            ", \"mean_error_m\": " + json_number(floor.mean_error_m) +
            ", \"worst_error_m\": " + json_number(floor.worst_error_m) +
            ", \"visits\": " + std::to_string(floor.visits) + "}";
  }
  return text + "]}";
}

}  // namespace

void print_table(std::FILE* out, const EvaluatedRun& run) {
  const double travelled_m = run.methods.empty() ? 0.0 : run.methods.front().evaluation.figures.travelled_m;
  std::fprintf(out, "%s: %.1f m in %.1f s\n\n", run.reference.source.c_str(), travelled_m,
               run.reference.trajectory.duration_s());
  if (run.methods.empty()) return;
  print_figures(out, run);
  print_floors(out, run);
  if (!run.notes.empty()) std::fprintf(out, "\n");
  for (const std::string& note : run.notes) std::fprintf(out, "Note: %s\n", note.c_str());
}

std::string figures_json(const EvaluatedRun& run) {
  std::string text = "{\n  \"reference\": " + json_text(run.reference.source.string()) +
                     ",\n  \"duration_s\": " + json_number(run.reference.trajectory.duration_s()) +
                     ",\n  \"travelled_m\": " +
                     json_number(evaluation::travelled_distance_m(run.reference.trajectory.poses).back()) +
                     ",\n  \"methods\": [\n";
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    text += method_json(run.methods[i]) + (i + 1 < run.methods.size() ? ",\n" : "\n");
  }
  return text + "  ]\n}\n";
}

}  // namespace isobar::report
