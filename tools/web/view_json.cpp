// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/view_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/version.hpp"

namespace isobar::web {
namespace {

using Json = nlohmann::ordered_json;

/// Rows of a track in the page.
constexpr std::size_t kMostTrackRows = 12'000;

}  // namespace

Json rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

double seconds_after(std::int64_t stamp_ns, std::int64_t origin_ns) {
  constexpr std::int64_t kUnitNs = 100'000;
  const std::int64_t units = (stamp_ns - origin_ns) / kUnitNs;
  return static_cast<double>(units) * 1e-4;
}

Json poses_json(const std::vector<PoseRow>& rows, std::int64_t origin_ns) {
  struct Column {
    const char* name;
    double PoseRow::*value;
    int decimals;
  };
  static constexpr std::array<Column, 8> kColumns{{{"x_m", &PoseRow::x_m, 3},
                                                   {"y_m", &PoseRow::y_m, 3},
                                                   {"z_m", &PoseRow::z_m, 4},
                                                   {"yaw_deg", &PoseRow::yaw_deg, 2},
                                                   {"z_sd_m", &PoseRow::z_sd_m, 4},
                                                   {"altimeter_m", &PoseRow::altimeter_m, 3},
                                                   {"bias_m", &PoseRow::bias_m, 4},
                                                   {"bias_sd_m", &PoseRow::bias_sd_m, 4}}};
  Json json = Json::object();
  Json& times = json["t_s"] = Json::array();
  for (const PoseRow& row : rows) times.push_back(rounded(seconds_after(row.stamp_ns, origin_ns), 4));
  for (const Column& column : kColumns) {
    Json& values = json[column.name] = Json::array();
    for (const PoseRow& row : rows) values.push_back(rounded(row.*column.value, column.decimals));
  }
  Json& registered = json["registered"] = Json::array();
  for (const PoseRow& row : rows) registered.push_back(row.registered ? 1 : 0);
  return json;
}

Json track_json(const std::string& name, const evaluation::Trajectory& trajectory, std::int64_t origin_ns) {
  const std::size_t step = trajectory.poses.size() / kMostTrackRows + 1;
  Json json{{"name", name},
            {"t_s", Json::array()},
            {"x_m", Json::array()},
            {"y_m", Json::array()},
            {"z_m", Json::array()}};
  for (std::size_t i = 0; i < trajectory.poses.size(); i += step) {
    const evaluation::StampedPose& pose = trajectory.poses[i];
    json["t_s"].push_back(rounded(seconds_after(pose.stamp_ns, origin_ns), 4));
    json["x_m"].push_back(rounded(pose.position_m.x(), 3));
    json["y_m"].push_back(rounded(pose.position_m.y(), 3));
    json["z_m"].push_back(rounded(pose.position_m.z(), 4));
  }
  return json;
}

Json floors_json(const std::vector<Floor>& floors, const files::FloorNames& names) {
  Json json = Json::array();
  for (const Floor& floor : floors) {
    json.push_back(
        {{"number", floor.number}, {"name", names.name_of(floor)}, {"z_m", rounded(floor.height_m, 3)}});
  }
  return json;
}

Json map_json(const MapState& map) {
  return {{"epoch", map.epoch}, {"change", map.change}, {"points", map.points}, {"left_out", map.left_out}};
}

Json note_json(const std::string& name, const std::string& level, const std::string& message) {
  return {{"name", name}, {"level", level}, {"message", message}, {"value", nullptr}};
}

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json empty_view(const std::string& kind, const std::string& title, std::int64_t origin_ns) {
  Json json{{"schema", 1},
            {"kind", kind},
            {"title", title},
            {"version", std::string(version())},
            {"origin_ns", std::to_string(origin_ns)},
            {"can_act", false}};
  json["poses"] = poses_json({}, origin_ns);
  for (const char* list : {"tracks", "floors", "signals", "sensors", "health", "counters", "settings"}) {
    json[list] = Json::array();
  }
  json["map"] = map_json({});
  return json;
}

}  // namespace isobar::web
