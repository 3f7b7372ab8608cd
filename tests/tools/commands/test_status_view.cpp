// SPDX-License-Identifier: BSD-3-Clause
// Screen, JSON and metrics of a health report.
#include <doctest/doctest.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tools/status/metrics.hpp"
#include "tools/status/view.hpp"

namespace isobar::test::test_status_view {

namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

/// A robot with a lidar that loses packets and without wheels.
HealthReport robot() {
  HealthReport report;
  CHECK(report.add("summary", HealthLevel::kWarning, "lidar/packets_lost: packets lost", 1.0));
  CHECK(report.add("lidar", HealthLevel::kOk, "10.0 per second", 10.0));
  CHECK(report.add("lidar/packets_lost", HealthLevel::kWarning,
                   "packets lost, by the gaps in the sensor's time, "
                   "over and over again",
                   123'456.0));
  CHECK(report.add("configuration", HealthLevel::kOk, "sha256 0123abcd in force for 3 h", 0.0));
  ipc::ServiceStatus& status = report.status;
  ipc::copy_text("robot", status.role, sizeof(status.role));
  status.uptime_s = 11'000.0;
  ipc::SensorStatus& lidar = status.add_sensor("lidar");
  lidar.heard = true;
  lidar.rate_hz = 10.0;
  lidar.age_s = 0.012;
  lidar.offset_s = -3.2;
  lidar.latency_ms = 0.4;
  lidar.latency_p99_ms = 123.45;
  lidar.jitter_ms = 0.3;
  lidar.samples = 12'345'678'901;
  lidar.lost = 123'456;
  status.add_sensor("wheels");
  ipc::StageStatus& stage = status.add_stage("registration");
  stage.outputs = 1'000'000'000;
  stage.misses = 999'999;
  stage.median_ms = 12.3;
  stage.p99_ms = 25.0;
  stage.worst_ms = 1'234.5;
  stage.limit_ms = 50.0;
  ipc::copy_text("registered", status.pose.mode, sizeof(status.pose.mode));
  ipc::copy_text("3dof", status.pose.method, sizeof(status.pose.method));
  status.pose.age_s = 0.05;
  status.pose.x_m = -12'345.678;
  status.pose.y_m = -2.0;
  status.pose.z_m = 3.5;
  status.pose.roll_deg = -179.9;
  status.pose.pitch_deg = -89.9;
  status.pose.yaw_deg = -179.9;
  status.pose.xy_sd_m = status.pose.z_sd_m = status.pose.yaw_sd_deg = 0.01;
  status.pose.overlap = 0.9;
  ipc::copy_text("differential", status.height.source, sizeof(status.height.source));
  status.height.age_s = 0.005;
  status.height.height_m = 3.5;
  status.height.sd_m = 0.03;
  status.height.bias_m = -0.25;
  status.height.bias_sd_m = 0.01;
  status.map = {.cells = 200'000, .tiles = 12, .disk_bytes = 4'000'000, .on_disk = true, .age_s = 0.1};
  return report;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("an old report is an error that says how old it is, whatever it says itself") {
  HealthReport report = robot();
  report.entries[0].level = HealthLevel::kOk;
  const std::string text = tools::status_text(report, 12.0, {});
  CHECK(text.starts_with("error         isobard sends no health report for 12.0 s: it hangs"));
  const auto json = nlohmann::json::parse(tools::status_json(report, 12.0));
  CHECK(json["level"] == "error");
  CHECK(tools::status_text(report, 0.5, {}).starts_with("ok "));
}

}  // namespace

TEST_CASE("the floor has its number, name and certainty, and no row where none is told") {
  HealthReport report = robot();
  CHECK_FALSE(has(tools::status_text(report, 0.2, {}), "\nfloor"));
  CHECK(nlohmann::json::parse(tools::status_json(report, 0.2)).at("floor").is_null());
  report.status.floor = {.present = true, .known = true, .number = -1, .certainty = 0.997, .z_m = -3.5};
  ipc::copy_text("parking", report.status.floor.name, sizeof(report.status.floor.name));
  CHECK(has(tools::status_text(report, 0.2, {}), "\nfloor         -1 (parking), certain to 100 %\n"));
  const auto json = nlohmann::json::parse(tools::status_json(report, 0.2)).at("floor");
  CHECK(json.at("number") == -1);
  CHECK(json.at("name") == "parking");
  report.status.floor.known = false;
  CHECK(has(tools::status_text(report, 0.2, {}), "\nfloor         not known; last: -1 (parking)\n"));
}

TEST_CASE("the screen has health first, at most 80 columns and 24 lines, and no colours in a pipe") {
  const std::string text = tools::status_text(robot(), 0.2, {});
  CHECK(text.starts_with("warning       lidar/packets_lost: packets lost\n"));
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    CAPTURE(line);
    CHECK(line.size() <= 80);
    CHECK(line.find('\033') == std::string::npos);
  }
  CHECK(count <= 24);
}

TEST_CASE("the screen shows sensors, pose, height with source and bias, map, configuration and stages") {
  const std::string text = tools::status_text(robot(), 0.2, {});
  for (const char* part :
       {"10.0 Hz", "-3.200 s", "0.40 ms", "123.45 ms", "0.30 ms", "never heard", "x -12345.678",
        "registered (3dof)", "sd 0.030 m; differential", "bias -0.250 m", "200000 cells",
        "12 tiles, 4.0 MB on disk", "sha256 0123abcd", "12.30 ms", "3 h 3 min", "[123456]"}) {
    CAPTURE(part);
    CAPTURE(text);
    CHECK(has(text, part));
  }
  CHECK_FALSE(has(text, "10.0 per second"));  // an entry that is ok
  CHECK(has(tools::status_text(robot(), 0.2, {.all = true}), "10.0 per second"));
  CHECK(has(tools::status_text(robot(), 0.2, {.all = true}), "12.3G"));
  CHECK(has(tools::status_text(robot(), 0.2, {.color = true}), "\033[1;33mwarning\033[0m"));
}

TEST_CASE("an offset of a clock has few figures at any size") {
  HealthReport report = robot();
  const auto shown = [&report](double offset_s) {
    report.status.sensors[0].offset_s = offset_s;
    return tools::status_text(report, 0.2, {});
  };
  CHECK(has(shown(0.0004), " +0.4 ms "));
  CHECK(has(shown(-1'203.4424), " -1203.442 s "));
  CHECK(has(shown(-28'800.0), " -8.0 h "));
  CHECK(has(shown(-1.764e9), " -20417 d "));
}

TEST_CASE("JSON is one line with every figure; one that does not exist is null") {
  const std::string line = tools::status_json(robot(), 0.2);
  CHECK_FALSE(has(line, "\n"));
  const auto json = nlohmann::json::parse(line);
  CHECK(json.at("schema") == 1);
  CHECK(json.at("level") == "warning");
  CHECK(json.at("health").size() == 4);
  CHECK(json.at("health").at(2).at("value") == 123'456.0);
  CHECK(json.at("sensors").at(0).at("name") == "lidar");
  CHECK(json.at("sensors").at(0).at("lost") == 123'456);
  CHECK(json.at("sensors").at(0).at("offset_s") == -3.2);
  CHECK(json.at("sensors").at(0).at("latency_p99_ms") == 123.45);
  CHECK(json.at("sensors").at(1).at("offset_s").is_null());
  CHECK(json.at("sensors").at(1).at("rate_hz").is_null());
  CHECK(json.at("pose").at("z_m") == 3.5);
  CHECK(json.at("height").at("source") == "differential");
  CHECK(json.at("stages").at(0).at("p99_ms") == 25.0);
  CHECK(nlohmann::json::parse(tools::status_json(HealthReport{}, 0.0)).at("pose").is_null());
}

TEST_CASE("metrics have units in their names, and without isobard only isobar_up 0") {
  const HealthReport report = robot();
  const std::string text = prometheus::TextSerializer().Serialize(tools::metrics_of(&report, 0.2));
  for (const char* line : {"isobar_up 1\n", "isobar_height_meters{source=\"differential\"} 3.5\n",
                           "isobar_sensor_rate_hertz{sensor=\"lidar\"} 10\n",
                           "isobar_sensor_clock_offset_seconds{sensor=\"lidar\"} -3.2",
                           "isobar_sensor_latency_seconds{sensor=\"lidar\",quantile=\"0.99\"} 0.12345",
                           "isobar_sensor_lost_total{sensor=\"lidar\"} 123456\n",
                           "isobar_health_level{entry=\"lidar/packets_lost\"} 1\n",
                           "# TYPE isobar_sensor_lost_total counter\n", "isobar_map_cells 200000\n"}) {
    CAPTURE(text);
    CHECK(has(text, line));
  }
  CHECK_FALSE(has(text, "nan"));
  CHECK_FALSE(has(text, "sensor_rate_hertz{sensor=\"wheels\"}"));
  const std::string absent = prometheus::TextSerializer().Serialize(tools::metrics_of(nullptr, 0.0));
  CHECK(has(absent, "isobar_up 0\n"));
  CHECK_FALSE(has(absent, "isobar_sensor"));
  CHECK(has(prometheus::TextSerializer().Serialize(tools::metrics_of(&report, 60.0)), "isobar_up 0\n"));
  // Of an isobard that hangs no figure is known any more, but the age of the last report.
  const std::string old = prometheus::TextSerializer().Serialize(tools::metrics_of(&report, 60.0));
  CHECK(has(old, "isobar_report_age_seconds 60\n"));
  CHECK_FALSE(has(old, "isobar_sensor"));
  CHECK_FALSE(has(old, "isobar_health_level"));
  CHECK_FALSE(has(old, "isobar_pose"));
  CHECK(has(text, "isobar_pose_age_seconds 0.25\n"));  // 0.05 s in a report that is 0.2 s old
}

}  // namespace isobar::test::test_status_view
