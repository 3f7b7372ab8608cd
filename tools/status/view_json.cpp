// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/status/view.hpp"

namespace isobar::tools {
namespace {

using Json = nlohmann::ordered_json;

Json health_json(const ipc::HealthReport& report) {
  Json entries = Json::array();
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    entries.push_back({{"name", entry.name},
                       {"level", ipc::level_name(entry.level)},
                       {"message", entry.message},
                       {"value", entry.value}});
  }
  return entries;
}

Json sensors_json(const ipc::ServiceStatus& status) {
  Json sensors = Json::array();
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.sensor_count, status.kMaxSensors); ++i) {
    const ipc::SensorStatus& sensor = status.sensors[i];
    sensors.push_back({{"name", sensor.name},
                       {"heard", sensor.heard},
                       {"rate_hz", sensor.rate_hz},
                       {"age_s", sensor.age_s},
                       {"offset_s", sensor.offset_s},
                       {"latency_ms", sensor.latency_ms},
                       {"latency_p99_ms", sensor.latency_p99_ms},
                       {"jitter_ms", sensor.jitter_ms},
                       {"samples", sensor.samples},
                       {"lost", sensor.lost},
                       {"rejected", sensor.rejected},
                       {"dropped", sensor.dropped}});
  }
  return sensors;
}

Json stages_json(const ipc::ServiceStatus& status) {
  Json stages = Json::array();
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.stage_count, status.kMaxStages); ++i) {
    const ipc::StageStatus& stage = status.stages[i];
    stages.push_back({{"name", stage.name},
                      {"outputs", stage.outputs},
                      {"misses", stage.misses},
                      {"median_ms", stage.median_ms},
                      {"p99_ms", stage.p99_ms},
                      {"worst_ms", stage.worst_ms},
                      {"limit_ms", stage.limit_ms}});
  }
  return stages;
}

Json pose_json(const ipc::PoseFigures& pose) {
  if (pose.mode[0] == '\0') return nullptr;
  return {{"mode", pose.mode},         {"method", pose.method},
          {"age_s", pose.age_s},       {"x_m", pose.x_m},
          {"y_m", pose.y_m},           {"z_m", pose.z_m},
          {"roll_deg", pose.roll_deg}, {"pitch_deg", pose.pitch_deg},
          {"yaw_deg", pose.yaw_deg},   {"xy_sd_m", pose.xy_sd_m},
          {"z_sd_m", pose.z_sd_m},     {"yaw_sd_deg", pose.yaw_sd_deg},
          {"overlap", pose.overlap}};
}

Json height_json(const ipc::HeightFigures& height) {
  if (height.source[0] == '\0') return nullptr;
  return {{"source", height.source}, {"age_s", height.age_s},   {"height_m", height.height_m},
          {"sd_m", height.sd_m},     {"bias_m", height.bias_m}, {"bias_sd_m", height.bias_sd_m}};
}

Json map_json(const ipc::ServiceStatus& status) {
  if (status.stage_count == 0) return nullptr;
  const ipc::MapFigures& map = status.map;
  return {{"cells", map.cells},
          {"on_disk", map.on_disk},
          {"tiles", map.tiles},
          {"disk_bytes", map.disk_bytes},
          {"age_s", map.age_s}};
}

Json floor_json(const ipc::FloorFigures& floor) {
  if (!floor.present) return nullptr;
  return {{"known", floor.known}, {"number", floor.number},       {"name", floor.name},
          {"place", floor.place}, {"certainty", floor.certainty}, {"z_m", floor.z_m}};
}

}  // namespace

std::string status_json(const ipc::HealthReport& report, double age_s) {
  const ipc::ServiceStatus& status = report.status;
  const Headline head = headline_of(report, age_s);
  Json json{{"schema", 1},
            {"level", ipc::level_name(head.level)},
            {"summary", head.text},
            {"stamp_ns", report.stamp_ns},
            {"report_age_s", age_s},
            {"role", status.role},
            {"uptime_s", status.uptime_s}};
  json["health"] = health_json(report);
  json["sensors"] = sensors_json(status);
  json["pose"] = pose_json(status.pose);
  json["height"] = height_json(status.height);
  json["map"] = map_json(status);
  json["floor"] = floor_json(status.floor);
  json["stages"] = stages_json(status);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace isobar::tools
