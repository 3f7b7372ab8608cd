// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/status/view.hpp"

namespace isobar::tools {
namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

constexpr std::size_t kColumns = 80;
/// Width of the row names.
constexpr std::size_t kNameColumns = 14;

std::string colored(HealthLevel level, const std::string& text, bool color) {
  if (!color) return text;
  const char* code = level == HealthLevel::kOk ? "32" : level == HealthLevel::kError ? "31" : "33";
  return fmt::format("\033[1;{}m{}\033[0m", code, text);
}

/// A figure with its unit, or a dash.
std::string figure(double value, int decimals, const char* unit) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}{}", value, decimals, unit);
}

std::string duration(double s) {
  if (std::isnan(s)) return "-";
  if (s < 60.0) return fmt::format("{:.{}f} s", s, s < 9.95 ? 2 : 1);
  const auto minutes = static_cast<long>(s / 60.0);
  if (minutes < 60) return fmt::format("{} min", minutes);
  if (minutes < 48L * 60) return fmt::format("{} h {} min", minutes / 60, minutes % 60);
  return fmt::format("{} d {} h", minutes / 1440, minutes / 60 % 24);
}

/// A count in at most seven columns.
std::string count(std::uint64_t n) {
  const auto value = static_cast<double>(n);
  if (n < 1'000'000) return std::to_string(n);
  return n < 1'000'000'000 ? fmt::format("{:.1f}M", value * 1e-6) : fmt::format("{:.1f}G", value * 1e-9);
}

/// `text` in lines after the row's name.
std::string row(const std::string& name, std::string_view text) {
  std::string out;
  std::string head = name;
  do {
    std::size_t length = std::min(text.size(), kColumns - kNameColumns);
    if (length < text.size()) {
      const std::size_t space = text.substr(0, length + 1).rfind(' ');
      if (space != std::string_view::npos && space > 0) length = space;
    }
    out += fmt::format("{:<{}}{}\n", head, kNameColumns, text.substr(0, length));
    text.remove_prefix(std::min(text.size(), length + (length < text.size() ? 1U : 0U)));
    head.clear();
  } while (!text.empty());
  return out;
}

std::string health_rows(const HealthReport& report, const ViewOptions& options) {
  std::string out;
  for (std::uint32_t i = 1; i < report.entry_count; ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    if (entry.level == HealthLevel::kOk && !options.all) continue;
    const std::string level = fmt::format("{:<8}", ipc::level_name(entry.level));
    // Counters end in their count.
    const bool is_counter = std::string_view(entry.name).find('/') != std::string_view::npos;
    const std::string value = is_counter && entry.value != 0.0 ? fmt::format(" [{:.6g}]", entry.value) : "";
    std::string text = fmt::format("{}: {}{}", entry.name, entry.message, value);
    std::string rows = row("  " + level, text);
    out +=
        colored(entry.level, rows.substr(0, 2 + level.size()), options.color) + rows.substr(2 + level.size());
  }
  return out;
}

/// Offset of a clock, signed, in at most eleven columns.
std::string clock_offset(double s) {
  if (std::isnan(s)) return "-";
  const double size = std::abs(s);
  if (size < 1.0) return fmt::format("{:+.1f} ms", s * 1e3);
  if (size < 10'000.0) return fmt::format("{:+.3f} s", s);
  return size < 172'800.0 ? fmt::format("{:+.1f} h", s / 3600.0) : fmt::format("{:+.0f} d", s / 86'400.0);
}

std::string sensor_rows(const ipc::ServiceStatus& status) {
  std::string out = fmt::format("{:<{}}{:>9}{:>8}{:>12}{:>10}{:>10}{:>9}{:>8}\n", "SENSOR", kNameColumns,
                                "rate", "age", "offset", "latency", "p99", "jitter", "lost");
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.sensor_count, status.kMaxSensors); ++i) {
    const ipc::SensorStatus& sensor = status.sensors[i];
    if (!sensor.heard) {
      out += fmt::format("{:<{}}never heard{:>55}\n", sensor.name, kNameColumns, count(sensor.lost));
      continue;
    }
    out += fmt::format("{:<{}}{:>9}{:>8}{:>12}{:>10}{:>10}{:>9}{:>8}\n", sensor.name, kNameColumns,
                       figure(sensor.rate_hz, 1, " Hz"), duration(std::max(0.0, sensor.age_s)),
                       clock_offset(sensor.offset_s), figure(sensor.latency_ms, 2, " ms"),
                       figure(sensor.latency_p99_ms, 2, " ms"), figure(sensor.jitter_ms, 2, " ms"),
                       count(sensor.lost));
  }
  return out;
}

/// What became of the samples; with --all.
std::string count_rows(const ipc::ServiceStatus& status) {
  std::string out =
      fmt::format("{:<{}}{:>15}{:>15}{:>15}\n", "SAMPLES", kNameColumns, "used", "refused", "dropped");
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.sensor_count, status.kMaxSensors); ++i) {
    const ipc::SensorStatus& sensor = status.sensors[i];
    out += fmt::format("{:<{}}{:>15}{:>15}{:>15}\n", sensor.name, kNameColumns, count(sensor.samples),
                       count(sensor.rejected), count(sensor.dropped));
  }
  return out;
}

std::string floor_row(const ipc::FloorFigures& floor) {
  if (!floor.present) return {};
  const std::string which =
      floor.name[0] == '\0' ? std::to_string(floor.number) : fmt::format("{} ({})", floor.number, floor.name);
  if (!floor.known && std::isnan(floor.z_m)) return row("floor", "none known yet");
  if (!floor.known) {
    return row("floor",
               fmt::format("{}; last: {}", floor.place[0] == '\0' ? "not known" : floor.place, which));
  }
  return row("floor", fmt::format("{}, certain to {}", which, figure(100.0 * floor.certainty, 0, " %")));
}

std::string estimate_rows(const ipc::ServiceStatus& status) {
  const ipc::PoseFigures& pose = status.pose;
  const ipc::HeightFigures& height = status.height;
  const ipc::MapFigures& map = status.map;
  std::string out;
  if (pose.mode[0] == '\0') {
    out += row("pose", "none yet");
  } else {
    out +=
        row("pose", fmt::format("x {:.3f}  y {:.3f}  z {:.3f} m   yaw {:.1f}  pitch {:.1f}  roll {:.1f} deg",
                                pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg, pose.pitch_deg, pose.roll_deg));
    out += row("", fmt::format("{} ({}), overlap {:.2f}, {} old", pose.mode, pose.method, pose.overlap,
                               duration(std::max(0.0, pose.age_s))));
    out += row("", fmt::format("sd xy {:.3f} m, z {:.3f} m, yaw {:.2f} deg", pose.xy_sd_m, pose.z_sd_m,
                               pose.yaw_sd_deg));
  }
  if (height.source[0] == '\0') {
    out += row("height", "none yet");
  } else {
    out += row("height", fmt::format("{:.3f} m, sd {:.3f} m; {}, {} old", height.height_m, height.sd_m,
                                     height.source, duration(std::max(0.0, height.age_s))));
    out += row("", fmt::format("bias {:.3f} m, sd {:.3f} m", height.bias_m, height.bias_sd_m));
  }
  out += floor_row(status.floor);
  const std::string disk = map.on_disk ? fmt::format("{} tiles, {:.1f} MB on disk", map.tiles,
                                                     static_cast<double>(map.disk_bytes) * 1e-6)
                                       : std::string("not written to disk");
  return out + row("map", fmt::format("{} cells in memory; {}", map.cells, disk));
}

std::string stage_rows(const ipc::ServiceStatus& status) {
  std::string out = fmt::format("{:<{}}{:>12}{:>12}{:>12}{:>12}{:>18}\n", "STAGE", kNameColumns, "median",
                                "p99", "worst", "limit", "late");
  for (std::uint32_t i = 0; i < std::min<std::size_t>(status.stage_count, status.kMaxStages); ++i) {
    const ipc::StageStatus& stage = status.stages[i];
    out += fmt::format("{:<{}}{:>12}{:>12}{:>12}{:>12}{:>18}\n", stage.name, kNameColumns,
                       figure(stage.median_ms, 2, " ms"), figure(stage.p99_ms, 2, " ms"),
                       figure(stage.worst_ms, 1, " ms"), figure(stage.limit_ms, 0, " ms"),
                       count(stage.misses) + " of " + count(stage.outputs));
  }
  return out;
}

}  // namespace

Headline headline_of(const HealthReport& report, double age_s) {
  if (report.entry_count == 0) return {HealthLevel::kStale, "no health report"};
  if (age_s > kOldReportS) {
    return {HealthLevel::kError,
            fmt::format("isobard sends no health report for {}: it hangs; all figures are of then",
                        duration(age_s))};
  }
  return {report.entries[0].level, report.entries[0].message};
}

std::string status_text(const HealthReport& report, double age_s, const ViewOptions& options) {
  if (report.entry_count == 0) return "no health report\n";
  const ipc::ServiceStatus& status = report.status;
  const Headline headline = headline_of(report, age_s);
  const std::string level = ipc::level_name(headline.level);
  std::string head = row(level, headline.text);
  head = colored(headline.level, head.substr(0, level.size()), options.color) + head.substr(level.size());
  std::string out = head;
  out += health_rows(report, options);
  out += row("isobard",
             fmt::format("{}, up for {}, report {} old; {} health entries", status.role,
                         duration(status.uptime_s), duration(std::max(0.0, age_s)), report.entry_count - 1));
  for (std::uint32_t i = 1; i < report.entry_count; ++i) {
    if (std::string_view(report.entries[i].name) == "configuration" && !options.all &&
        report.entries[i].level == HealthLevel::kOk) {
      out += row("configuration", report.entries[i].message);
    }
  }
  out += "\n" + sensor_rows(status);
  if (options.all) out += "\n" + count_rows(status);
  if (status.stage_count == 0) return out;
  return out + "\n" + estimate_rows(status) + "\n" + stage_rows(status);
}

}  // namespace isobar::tools
