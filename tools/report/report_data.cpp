// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report_data.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/report/html_page.hpp"
#include "tools/report/method_style.hpp"
#include "tools/report/report_charts.hpp"
#include "tools/web/inline_text.hpp"
#include "tools/web/map_tiles.hpp"
#include "tools/web/page_files.hpp"

namespace isobar::report {

namespace {

using Json = nlohmann::ordered_json;
using evaluation::PosePair;

// Rows of a curve: more than a screen has pixels, at any zoom that a reader uses.
constexpr std::size_t kMostRows = 6000;

// Points of a map in the file, 11 bytes each: of the method that the report is about, and of each other one.
constexpr std::size_t kMainMapPoints = 400'000;
constexpr std::size_t kOtherMapPoints = 120'000;

double millimetres(double value_m) { return std::round(1e3 * value_m) / 1e3; }

/// Columns of a line in space.
class Way {
 public:
  explicit Way(std::size_t rows) : step_(rows / kMostRows + 1) {}

  /// Takes every n-th row whose distance is beyond the last one's: a chart needs ascending ones.
  bool takes(std::size_t row, double distance_m) {
    if (row % step_ != 0 || !(millimetres(distance_m) > last_m_)) return false;
    last_m_ = millimetres(distance_m);
    return true;
  }
  void add(double distance_m, const Eigen::Vector3d& position_m) {
    columns["distance_m"].push_back(millimetres(distance_m));
    columns["x_m"].push_back(millimetres(position_m.x()));
    columns["y_m"].push_back(millimetres(position_m.y()));
    columns["z_m"].push_back(millimetres(position_m.z()));
  }

  Json columns{{"distance_m", Json::array()},
               {"x_m", Json::array()},
               {"y_m", Json::array()},
               {"z_m", Json::array()},
               {"error_m", Json::array()}};

 private:
  std::size_t step_;
  double last_m_ = -std::numeric_limits<double>::infinity();
};

/// Name and look of a line.
Json line_json(const std::string& name, const Stroke& stroke) {
  return {{"name", name}, {"colour", stroke.colour}, {"width", stroke.width}, {"dash", dash_lengths(stroke)}};
}

Json reference_json(const evaluation::Trajectory& reference) {
  const std::vector<double> distance_m = evaluation::travelled_distance_m(reference.poses);
  Way way(reference.poses.size());
  for (std::size_t i = 0; i < reference.poses.size(); ++i) {
    if (way.takes(i, distance_m[i])) way.add(distance_m[i], reference.poses[i].position_m);
  }
  Json json = line_json("reference", kReferenceStroke);
  json.update(way.columns);
  return json;
}

/// Heights of the altimeter; null without one.
Json altimeter_json(const evaluation::EvaluatedRun& run) {
  const Curve curve = altimeter_curve(run);
  if (curve.x.empty()) return nullptr;
  Way way(curve.x.size());
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (way.takes(i, curve.x[i])) way.add(curve.x[i], {0.0, 0.0, curve.y[i]});
  }
  Json json = line_json(curve.name, curve.stroke);
  json.update({{"distance_m", way.columns["distance_m"]}, {"z_m", way.columns["z_m"]}});
  return json;
}

Json method_json(const evaluation::EvaluatedRun& run, const evaluation::EvaluatedMethod& method) {
  const std::vector<PosePair>& pairs = method.evaluation.pairs;
  Way way(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!way.takes(i, pairs[i].distance_m)) continue;
    way.add(pairs[i].distance_m, pairs[i].estimate.position_m);
    way.columns["error_m"].push_back(
        millimetres(pairs[i].estimate.position_m.z() - pairs[i].reference.position_m.z()));
  }
  const evaluation::Verdict& verdict = method.evaluation.figures.verdict;
  Json json = line_json(evaluation::display_name(method.name), method_stroke(run, method));
  json.update({{"verdict", evaluation::verdict_word(verdict.kind)},
               {"reason", verdict.reason},
               {"has_map", !method.map_points.empty()}});
  json.update(way.columns);
  return json;
}

/// Distances from the first to the last pose of each flat segment.
Json flat_json(const evaluation::EvaluatedRun& run) {
  Json spans = Json::array();
  const std::vector<PosePair>& pairs = main_method(run).evaluation.pairs;
  for (const evaluation::Segment& segment : evaluation::flat_segments(run.reference.segments)) {
    std::optional<double> from_m;
    double to_m = 0.0;
    for (const PosePair& pair : pairs) {
      if (!segment.contains(pair.stamp_ns)) continue;
      if (!from_m) from_m = pair.distance_m;
      to_m = pair.distance_m;
    }
    if (from_m) spans.push_back({millimetres(*from_m), millimetres(to_m)});
  }
  return spans;
}

Json floors_json(const evaluation::EvaluatedRun& run) {
  Json floors = Json::array();
  int number = 0;
  for (const double level_m : evaluation::floor_levels_m(run)) {
    floors.push_back({{"number", number++}, {"name", ""}, {"z_m", millimetres(level_m)}});
  }
  return floors;
}

std::string map_base64(const std::vector<std::array<float, 3>>& points_m, std::size_t most) {
  web::MapDraft draft;
  const std::size_t step = points_m.size() / most + 1;
  for (std::size_t i = 0; i < points_m.size(); i += step) {
    const auto& [x, y, z] = points_m[i];
    draft.add(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z), 0);
  }
  web::MapTiles tiles(1);
  tiles.replace(std::move(draft));
  return web::base64(tiles.changes_since(0, 0, std::numeric_limits<std::size_t>::max()));
}

}  // namespace

std::string report_data_json(const evaluation::EvaluatedRun& run) {
  Json json{{"schema", 1},
            {"main", &main_method(run) - run.methods.data()},
            {"reference", reference_json(run.reference.trajectory)},
            {"altimeter", altimeter_json(run)},
            {"methods", Json::array()},
            {"flat", flat_json(run)},
            {"floors", floors_json(run)}};
  for (const evaluation::EvaluatedMethod& method : run.methods)
    json["methods"].push_back(method_json(run, method));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string way_and_map(const evaluation::EvaluatedRun& run) {
  if (web::page_files().empty()) return no_chart(web::kPicturesMissing);
  std::string html =
      "<div id=\"isobar-report-view\">" + no_chart("Curves and map need JavaScript.") + "</div>\n";
  html += "<script type=\"application/json\" id=\"isobar-report\">" +
          web::script_safe(report_data_json(run)) + "</script>\n";
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    if (method.map_points.empty()) continue;
    const bool is_main = &method == &main_method(run);
    html += "<script type=\"text/plain\" id=\"isobar-map-" + std::to_string(&method - run.methods.data()) +
            "\">" + map_base64(method.map_points, is_main ? kMainMapPoints : kOtherMapPoints) + "</script>\n";
  }
  return html;
}

}  // namespace isobar::report
