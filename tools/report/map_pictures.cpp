// SPDX-License-Identifier: BSD-3-Clause
// The report's side and plan views of the map.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/statistics/distribution.hpp"
#include "tools/report/map_view.hpp"
#include "tools/report/method_style.hpp"
#include "tools/report/report_pictures.hpp"

namespace isobar::report {

namespace {

using evaluation::PosePair;

constexpr double kCmPerM = 100.0;

/// An orthographic projection: directions in the reference's frame that point right and up.
struct View {
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d v = Eigen::Vector3d::UnitY();
  std::string u_label;
  std::string v_label;
};

/// Principal horizontal direction of the path [rad], 0 … pi, rounded to x or y within 10 degrees.
double long_side_rad(const std::vector<evaluation::StampedPose>& poses) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& pose : poses) mean += pose.position_m.head<2>() / static_cast<double>(poses.size());
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const auto& pose : poses) {
    const Eigen::Vector2d d = pose.position_m.head<2>() - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
  const double axis = kQuarterTurn * std::round(angle / kQuarterTurn);
  constexpr double kNearAxis = 10.0 / 180.0 * std::numbers::pi;
  const double chosen = std::abs(angle - axis) < kNearAxis ? axis : angle;
  return chosen < 0.0 ? chosen + std::numbers::pi : chosen;
}

View side_view(const evaluation::EvaluatedRun& run) {
  const double angle = long_side_rad(run.reference.trajectory.poses);
  View view;
  view.u = {std::cos(angle), std::sin(angle), 0.0};
  view.v = Eigen::Vector3d::UnitZ();
  view.v_label = "height [m]";
  const double degrees = angle * 180.0 / std::numbers::pi;
  if (std::abs(view.u.y()) < 1e-9) {
    view.u_label = "x [m]";
  } else if (std::abs(view.u.x()) < 1e-9) {
    view.u_label = "y [m]";
  } else {
    view.u_label = "along " + fixed(degrees, 0) + "\u00b0 from x [m]";
  }
  return view;
}

std::vector<MapPoint> projected(const std::vector<std::array<float, 3>>& points, const View& view) {
  const Eigen::Vector3f u = view.u.cast<float>();
  const Eigen::Vector3f v = view.v.cast<float>();
  std::vector<MapPoint> result;
  result.reserve(points.size());
  for (const auto& point : points) {
    const Eigen::Map<const Eigen::Vector3f> p(point.data());
    result.push_back({u.dot(p), v.dot(p)});
  }
  return result;
}

/// Range from the 0.2nd to the 99.8th percentile: a few stray returns must not shrink the picture.
Range range_of_most(const std::vector<MapPoint>& points, float MapPoint::*coordinate) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const MapPoint& point : points) values.push_back(static_cast<double>(point.*coordinate));
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.002), quantile(values, 0.998)};
}

Series projected_path(const evaluation::EvaluatedRun& run, const evaluation::EvaluatedMethod& method,
                      const View& view) {
  Series series{evaluation::display_name(method.name), method_stroke(run, method), {}, {}};
  for (const PosePair& pair : method.evaluation.pairs) {
    series.x.push_back(view.u.dot(pair.estimate.position_m));
    series.y.push_back(view.v.dot(pair.estimate.position_m));
  }
  return series;
}

Series projected_reference(const evaluation::EvaluatedRun& run, const View& view) {
  Series series{"Reference", kReferenceStroke, {}, {}};
  for (const auto& pose : run.reference.trajectory.poses) {
    series.x.push_back(view.u.dot(pose.position_m));
    series.y.push_back(view.v.dot(pose.position_m));
  }
  return series;
}

/// Range of the paths and of nearly all points, with a margin.
void set_ranges(MapView& map) {
  map.u = range_of(map.paths.front().x);
  map.v = range_of(map.paths.front().y);
  for (const Series& path : map.paths) {
    map.u = united(map.u, range_of(path.x));
    map.v = united(map.v, range_of(path.y));
  }
  if (!map.points.empty()) {
    map.u = united(map.u, range_of_most(map.points, &MapPoint::u));
    map.v = united(map.v, range_of_most(map.points, &MapPoint::v));
  }
  map.u = padded(map.u, 0.02, 4.0);
  map.v = padded(map.v, 0.03, 2.0);
}

/// Vertical exaggeration at which storeys can be told apart: 1, 2, 3, 5 or 10.
double readable_exaggeration(const MapView& map) {
  constexpr double kLowestPx = 150.0;
  constexpr double kInnerPx = 900.0;
  const double height_px = kInnerPx * (map.v.high - map.v.low) / (map.u.high - map.u.low);
  for (const double factor : {1.0, 2.0, 3.0, 5.0}) {
    if (factor * height_px >= kLowestPx) return factor;
  }
  return 10.0;
}

/// A signed length, in centimetres below a metre.
std::string length_label(double length_m) {
  if (std::abs(length_m) < 1.0) return fixed_signed(kCmPerM * length_m, 1) + " cm";
  return fixed_signed(length_m, 2) + " m";
}

MapView side_map(const evaluation::EvaluatedRun& run, const evaluation::EvaluatedMethod& method,
                 const View& view) {
  MapView map;
  map.u_label = view.u_label;
  map.v_label = view.v_label;
  map.points = projected(method.map_points, view);
  map.paths.push_back(projected_reference(run, view));
  map.paths.push_back(projected_path(run, method, view));
  for (const double level_m : evaluation::floor_levels_m(run)) {
    const evaluation::FloorHeight* floor = evaluation::floor_at(method, level_m, run.options.floor_gap_m);
    if (floor != nullptr) map.levels.push_back({level_m, length_label(floor->mean_error_m)});
  }
  map.max_height = 560.0;
  return map;
}

}  // namespace

std::vector<SideView> side_view_pictures(const evaluation::EvaluatedRun& run) {
  const View view = side_view(run);
  std::vector<const evaluation::EvaluatedMethod*> methods;
  if (!main_method(run).map_points.empty()) methods.push_back(&main_method(run));
  if (const evaluation::EvaluatedMethod* contrast = contrast_method(run, true)) methods.push_back(contrast);
  std::vector<MapView> maps;
  for (const evaluation::EvaluatedMethod* method : methods) {
    maps.push_back(side_map(run, *method, view));
    set_ranges(maps.back());
  }
  std::vector<SideView> pictures;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    MapView& map = maps[i];
    for (const MapView& other : maps) {  // one window for all, so that they can be compared
      map.u = united(map.u, other.u);
      map.v = united(map.v, other.v);
    }
    map.v_exaggeration = readable_exaggeration(map);
    if (map.v_exaggeration > 1.0) map.v_label += ", " + fixed(map.v_exaggeration, 0) + " times exaggerated";
    const bool is_tall = map.v.high - map.v.low > 0.8 * (map.u.high - map.u.low);
    map.width = is_tall ? 510.0 : 1040.0;  // tall ones stand side by side
    map.id = "side" + std::to_string(i);
    pictures.push_back({evaluation::display_name(methods[i]->name), draw(map), is_tall});
  }
  return pictures;
}

Picture top_view_picture(const evaluation::EvaluatedRun& run) {
  View view{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), "x [m]", "y [m]"};
  const auto make_map = [&] {
    MapView map;
    map.points = projected(main_method(run).map_points, view);
    map.paths.push_back(projected_reference(run, view));
    for (const evaluation::EvaluatedMethod& method : run.methods)
      map.paths.push_back(projected_path(run, method, view));
    set_ranges(map);
    return map;
  };
  MapView map = make_map();
  if (map.v.high - map.v.low > 1.2 * (map.u.high - map.u.low)) {  // lay the long side along the page
    view = {Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX(), "y [m]", "\u2212x [m]"};
    map = make_map();
  }
  map.u_label = view.u_label;
  map.v_label = view.v_label;
  map.max_height = 620.0;
  map.id = "top";
  return draw(map);
}

}  // namespace isobar::report
