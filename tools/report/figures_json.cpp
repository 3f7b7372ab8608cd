// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/figures_json.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>

#include "tools/report/figure_rows.hpp"
#include "tools/report/provenance.hpp"

namespace isobar::report {

namespace {

using Json = nlohmann::ordered_json;

/// Nine significant digits: nanometres in a kilometre. Null when not finite.
Json json_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return std::strtod(text.data(), nullptr);
}

/// Shares are stored as 0 … 1; any other value is scaled to the shown unit (degrees).
double json_value(const FigureRow& row, const evaluation::MethodFigures& figures) {
  const bool is_share = std::string_view(row.unit).starts_with('%');
  return row.value(figures) * (is_share ? 1.0 : row.scale);
}

Json floor_json(const evaluation::FloorHeight& floor) {
  return {{"reference_m", json_number(floor.reference_m)},
          {"mean_error_m", json_number(floor.mean_error_m)},
          {"worst_error_m", json_number(floor.worst_error_m)},
          {"visits", floor.visits}};
}

Json method_json(const evaluation::EvaluatedMethod& method) {
  const evaluation::MethodFigures& figures = method.evaluation.figures;
  Json json{{"name", method.name},
            {"source", method.source.string()},
            {"verdict", evaluation::verdict_word(figures.verdict.kind)},
            {"verdict_reason", figures.verdict.reason},
            {"lost", figures.verdict.kind == evaluation::VerdictKind::kLost},
            {"z_rpe_over_whole_run", figures.whole_run_as_flat}};
  for (const FigureRow& row : figure_rows()) json[row.key] = json_number(json_value(row, figures));
  json["floors"] = Json::array();
  for (const evaluation::FloorHeight& floor : figures.floors) json["floors"].push_back(floor_json(floor));
  return json;
}

}  // namespace

std::string figures_json(const evaluation::EvaluatedRun& run) {
  const auto& poses = run.reference.trajectory.poses;
  Json json{{"made_by", provenance_line()},
            {"reference", run.reference.source.string()},
            {"duration_s", json_number(run.reference.trajectory.duration_s())},
            {"travelled_m", json_number(evaluation::travelled_distance_m(poses).back())},
            {"methods", Json::array()}};
  for (const evaluation::EvaluatedMethod& method : run.methods)
    json["methods"].push_back(method_json(method));
  for (const DifferingSetting& setting : differing_settings(run))
    json["differing_settings"][setting.key] = setting.values;
  // Invalid UTF-8 in a name or path is replaced, so that it does not stop the report.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace isobar::report
