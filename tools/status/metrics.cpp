// SPDX-License-Identifier: BSD-3-Clause
#include "tools/status/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tools/status/health_reader.hpp"
#include "tools/status/view.hpp"

namespace isobar::tools {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// Families in the order of their first sample.
class Families {
 public:
  /// Adds a sample to the family of this name; a value that does not exist is left out.
  void gauge(const char* name, const char* help, double value, Labels labels = {}) {
    if (std::isnan(value)) return;
    ClientMetric metric;
    metric.label = std::move(labels);
    metric.gauge.value = value;
    family(name, help, MetricType::Gauge).metric.push_back(std::move(metric));
  }
  void counter(const char* name, const char* help, std::uint64_t value, Labels labels) {
    ClientMetric metric;
    metric.label = std::move(labels);
    metric.counter.value = static_cast<double>(value);
    family(name, help, MetricType::Counter).metric.push_back(std::move(metric));
  }
  [[nodiscard]] std::vector<MetricFamily> take() { return std::move(families_); }

 private:
  MetricFamily& family(const char* name, const char* help, MetricType type) {
    const auto known = std::find_if(families_.begin(), families_.end(),
                                    [name](const MetricFamily& other) { return other.name == name; });
    if (known != families_.end()) return *known;
    families_.push_back({name, help, type, {}});
    return families_.back();
  }
  std::vector<MetricFamily> families_;
};

void add_health(const ipc::HealthReport& report, Families& out) {
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    const Labels labels{{"entry", entry.name}};
    out.gauge("isobar_health_level", "Level of a health entry: 0 ok, 1 warning, 2 error, 3 stale",
              static_cast<double>(entry.level), labels);
    out.gauge("isobar_health_value", "Value of a health entry, in the unit of its message", entry.value,
              labels);
  }
}

void add_sensors(const ipc::ServiceStatus& status, double age_s, Families& out) {
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.sensor_count, status.kMaxSensors); ++i) {
    const ipc::SensorStatus& sensor = status.sensors[i];
    const Labels labels{{"sensor", sensor.name}};
    out.gauge("isobar_sensor_heard", "1 if the sensor has sent at least one sample", sensor.heard ? 1.0 : 0.0,
              labels);
    if (sensor.heard) {
      out.gauge("isobar_sensor_rate_hertz", "Samples a second; of a lidar, scans", sensor.rate_hz, labels);
      out.gauge("isobar_sensor_age_seconds", "Time since the newest sample was measured",
                sensor.age_s + age_s, labels);
      out.gauge("isobar_sensor_jitter_seconds", "Standard deviation of the interval between arrivals",
                sensor.jitter_ms * 1e-3, labels);
      out.gauge("isobar_sensor_clock_offset_seconds", "Sensor's clock minus the robot clock", sensor.offset_s,
                labels);
      const char* latency = "Time from the measurement to its arrival, quantile of the last 10 to 20 s";
      out.gauge("isobar_sensor_latency_seconds", latency, sensor.latency_ms * 1e-3,
                {{"sensor", sensor.name}, {"quantile", "0.5"}});
      out.gauge("isobar_sensor_latency_seconds", latency, sensor.latency_p99_ms * 1e-3,
                {{"sensor", sensor.name}, {"quantile", "0.99"}});
    }
    out.counter("isobar_sensor_samples_total", "Samples used", sensor.samples, labels);
    out.counter("isobar_sensor_lost_total", "Samples lost before they arrived", sensor.lost, labels);
    out.counter("isobar_sensor_rejected_total", "Samples received and refused", sensor.rejected, labels);
    out.counter("isobar_sensor_dropped_total", "Samples received and dropped for want of time or memory",
                sensor.dropped, labels);
  }
}

void add_stages(const ipc::ServiceStatus& status, Families& out) {
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.stage_count, status.kMaxStages); ++i) {
    const ipc::StageStatus& stage = status.stages[i];
    const char* help = "Time from complete input to output, quantile of the last minute";
    out.gauge("isobar_stage_latency_seconds", help, stage.median_ms * 1e-3,
              {{"stage", stage.name}, {"quantile", "0.5"}});
    out.gauge("isobar_stage_latency_seconds", help, stage.p99_ms * 1e-3,
              {{"stage", stage.name}, {"quantile", "0.99"}});
    out.counter("isobar_stage_outputs_total", "Outputs of a stage", stage.outputs, {{"stage", stage.name}});
    out.counter("isobar_stage_deadline_misses_total", "Outputs later than the stage's deadline", stage.misses,
                {{"stage", stage.name}});
  }
}

void add_estimate(const ipc::ServiceStatus& status, double age_s, Families& out) {
  if (status.pose.mode[0] != '\0') {
    const ipc::PoseFigures& pose = status.pose;
    const char* help = "Position of base_link in the map frame";
    out.gauge("isobar_pose_position_meters", help, pose.x_m, {{"axis", "x"}});
    out.gauge("isobar_pose_position_meters", help, pose.y_m, {{"axis", "y"}});
    out.gauge("isobar_pose_position_meters", help, pose.z_m, {{"axis", "z"}});
    out.gauge("isobar_pose_yaw_degrees", "Yaw of base_link in the map frame", pose.yaw_deg);
    out.gauge("isobar_pose_age_seconds", "Time since the stamp of the newest pose", pose.age_s + age_s);
    out.gauge("isobar_pose_overlap_ratio", "Share of the scan's points that match the map", pose.overlap);
  }
  if (status.height.source[0] != '\0') {
    const ipc::HeightFigures& height = status.height;
    out.gauge("isobar_height_meters", "Height of base_link above its start from air pressure",
              height.height_m, {{"source", height.source}});
    out.gauge("isobar_height_sigma_meters", "Standard deviation of the height", height.sd_m);
    out.gauge("isobar_height_bias_meters", "Estimated offset of the barometric height", height.bias_m);
  }
  if (status.stage_count > 0) {
    out.gauge("isobar_map_cells", "Cells of the map in memory", static_cast<double>(status.map.cells));
    out.gauge("isobar_map_tiles", "Tiles of the map on disk", static_cast<double>(status.map.tiles));
    out.gauge("isobar_map_disk_bytes", "Size of the map on disk", static_cast<double>(status.map.disk_bytes));
  }
}

}  // namespace

std::vector<MetricFamily> metrics_of(const ipc::HealthReport* report, double age_s) {
  Families out;
  const bool up = report != nullptr && age_s < kOldReportS;
  out.gauge("isobar_up", "1 if isobard runs and reports its health", up ? 1.0 : 0.0);
  if (report == nullptr) return out.take();
  out.gauge("isobar_report_age_seconds", "Time since the health report was made", age_s);
  if (!up) return out.take();  // figures that nobody knows any more
  out.gauge("isobar_uptime_seconds", "Time since isobard started", report->status.uptime_s);
  add_health(*report, out);
  add_sensors(report->status, age_s, out);
  add_stages(report->status, out);
  add_estimate(report->status, age_s, out);
  return out.take();
}

void MetricsSource::put(const ipc::HealthReport& report) {
  const std::lock_guard lock(mutex_);
  report_ = report;
}

void MetricsSource::put_absence() {
  const std::lock_guard lock(mutex_);
  report_.reset();
}

std::vector<MetricFamily> MetricsSource::Collect() const {
  const std::lock_guard lock(mutex_);
  return metrics_of(report_ ? &*report_ : nullptr, report_ ? HealthReader::age_s(*report_) : 0.0);
}

}  // namespace isobar::tools
