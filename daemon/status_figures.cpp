// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/status_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/geometry.hpp"
#include "core/names.hpp"
#include "core/stamp.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/timing_health.hpp"

namespace isobar {
namespace {

using datagram::Kind;
using ipc::SensorStatus;
using ipc::ServiceStatus;

double age_s(std::int64_t last_ns, std::int64_t now_ns) {
  return last_ns == 0 ? ipc::kNoValue : seconds_between(last_ns, now_ns);
}

void add_lidar(const StatusSnapshot& now, const StatusSnapshot& before, double elapsed_s,
               ServiceStatus& out) {
  const auto& counters = now.lidar.counters;
  SensorStatus& lidar = out.add_sensor("lidar");
  lidar.heard = now.lidar.last_packet_ns != 0;
  lidar.rate_hz = per_second(counters.scans, before.lidar.counters.scans, elapsed_s);
  lidar.age_s = age_s(now.lidar.last_packet_ns, now.now_ns);
  fill_timing(now.lidar.arrivals.figures(now.now_ns), lidar);
  lidar.samples = counters.scans;
  lidar.lost = counters.lost;
  lidar.rejected =
      counters.garbage + counters.truncated + counters.oversized + counters.wrong_model + counters.too_late;
  lidar.dropped =
      now.lidar.dropped_by_kernel + now.lidar.scans_without_memory + now.registration.dropped_scans;
}

/// Samples that arrived and were refused, by Kind.
std::array<std::uint64_t, datagram::kKinds> rejected(const StatusSnapshot& now) {
  const PriorCounters& used = now.prior.counters;
  const auto& base = now.samples.base;
  std::uint64_t base_refused = used.base_bad_value + used.base_bad_time + used.base_stale;
  for (std::size_t verdict = 0; verdict < base.samples.size(); ++verdict) {
    if (verdict != static_cast<std::size_t>(BaseVerdict::kAccepted)) base_refused += base.samples[verdict];
  }
  const std::uint64_t pressure_refused =
      used.pressure_bad_value + used.pressure_bad_time + now.barometer.device.counters.implausible;
  const auto& refused = now.samples.refused;
  const std::uint64_t imu_refused =
      used.imu_bad_value + used.imu_bad_time + now.imu.device.counters.implausible;
  const std::uint64_t wheels_refused =
      used.wheel_bad_value + used.wheel_bad_time + now.wheels.device.counters.implausible;
  return {imu_refused + refused[0], pressure_refused + refused[1], base_refused + refused[2],
          wheels_refused + refused[3]};
}

void add_samples(const StatusSnapshot& now, const StatusSnapshot& before, double elapsed_s,
                 ServiceStatus& out) {
  constexpr std::array<const char*, datagram::kKinds> kNames{"imu", "barometer", "base_station", "wheels"};
  const auto refused = rejected(now);
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    SensorStatus& sensor = out.add_sensor(kNames[kind]);
    sensor.heard = now.prior.samples[kind] > 0;
    sensor.rate_hz = per_second(now.prior.samples[kind], before.prior.samples[kind], elapsed_s);
    sensor.age_s = age_s(now.prior.last_sample_ns[kind], now.now_ns);
    fill_timing(now.prior.arrivals[kind].figures(now.now_ns), sensor);
    sensor.samples = now.prior.samples[kind];
    sensor.lost = now.samples.counters.lost[kind];
    sensor.rejected = refused[kind];
    sensor.dropped = now.prior.dropped[kind];
  }
  // A base station may send less than once a second: its own interval, not a count of this second.
  const std::int64_t interval_ns = now.prior.base_stations[0].interval_ns();
  SensorStatus& base = out.sensors[1 + static_cast<std::size_t>(Kind::kBasePressure)];
  if (interval_ns > 0 && !now.prior.base_stations[0].silent(now.now_ns)) {
    base.rate_hz = 1e9 / static_cast<double>(interval_ns);
  }
}

void fill_pose(const RegistrationStatus& registration, std::int64_t now_ns, ipc::PoseFigures& out) {
  const PoseSummary& pose = registration.pose;
  if (pose.stamp_ns == 0) return;
  const auto sd = [&pose](std::size_t i) { return std::sqrt(std::max(0.0, pose.variances[i])); };
  ipc::copy_text(kPoseModeNames.name(registration.mode), out.mode, sizeof(out.mode));
  ipc::copy_text(kMethodNames.name(registration.effective_method), out.method, sizeof(out.method));
  out.age_s = seconds_between(pose.stamp_ns, now_ns);
  out.x_m = pose.p_map_m[0];
  out.y_m = pose.p_map_m[1];
  out.z_m = pose.p_map_m[2];
  out.roll_deg = pose.rpy_rad[0] / kRadPerDeg;
  out.pitch_deg = pose.rpy_rad[1] / kRadPerDeg;
  out.yaw_deg = pose.rpy_rad[2] / kRadPerDeg;
  out.xy_sd_m = std::max(sd(0), sd(1));
  out.z_sd_m = sd(2);
  out.yaw_sd_deg = sd(5) / kRadPerDeg;
  out.overlap = registration.overlap;
}

void fill_height(const PriorStatus& prior, std::int64_t now_ns, ipc::HeightFigures& out) {
  if (prior.stamp_ns == 0) return;
  ipc::copy_text(kHeightSourceNames.name(prior.height_source), out.source, sizeof(out.source));
  out.age_s = seconds_between(prior.stamp_ns, now_ns);
  out.height_m = prior.height_m;
  out.sd_m = std::sqrt(std::max(0.0, prior.height_variance_m2));
  out.bias_m = prior.barometers.height_bias_m;
  out.bias_sd_m = prior.barometers.height_bias_sd_m;
}

double elapsed(std::int64_t before_ns, std::int64_t now_ns) {
  return before_ns == 0 ? 1.0 : seconds_between(before_ns, now_ns);
}

}  // namespace

void StageTimes::add(const char* name, const DeadlineStatus& stage, std::int64_t now_ns, ServiceStatus& out) {
  std::deque<Reading>& readings = readings_[name];
  while (readings.size() > 1 && now_ns - readings.front().time_ns > kWindowNs) readings.pop_front();
  ipc::StageStatus& figures = out.add_stage(name);
  figures.outputs = stage.outputs;
  figures.misses = stage.misses;
  figures.limit_ms = static_cast<double>(stage.limit_ns) * 1e-6;
  const LatencyHistogram before = readings.empty() ? LatencyHistogram{} : readings.front().times;
  figures.median_ms = stage.times.quantile_ms(0.5, before);
  figures.p99_ms = stage.times.quantile_ms(0.99, before);
  if (stage.outputs > 0) figures.worst_ms = static_cast<double>(stage.worst_ns) * 1e-6;
  if (readings.empty()) readings.push_back({now_ns, LatencyHistogram{}});
  if (now_ns - readings.back().time_ns >= kStepNs) readings.push_back({now_ns, stage.times});
}

void fill_floor(const ipc::CurrentFloor& floor, ipc::FloorFigures& out) {
  out.present = true;
  out.known = floor.known;
  out.number = floor.number;
  ipc::copy_text(kFloorPlaceTexts.name(floor.place), out.place, sizeof(out.place));
  out.certainty = floor.certainty;
  out.z_m = floor.z_m;
  const std::string_view name(floor.name, strnlen(floor.name, sizeof(floor.name)));
  ipc::copy_text(name, out.name, sizeof(out.name));
}

void fill_robot_figures(const StatusSnapshot& now, const StatusSnapshot& before, StageTimes& times,
                        ServiceStatus& out) {
  const double elapsed_s = elapsed(before.now_ns, now.now_ns);
  ipc::copy_text("robot", out.role, sizeof(out.role));
  add_lidar(now, before, elapsed_s, out);
  add_samples(now, before, elapsed_s, out);
  times.add("lidar", now.lidar.punctuality, now.now_ns, out);
  times.add("prior", now.prior.punctuality, now.now_ns, out);
  times.add("registration", now.registration.punctuality, now.now_ns, out);
  times.add("map", now.map.punctuality, now.now_ns, out);
  fill_pose(now.registration, now.now_ns, out.pose);
  fill_height(now.prior, now.now_ns, out.height);
  out.map = {.cells = now.map.cells,
             .tiles = now.map.tiles_on_disk,
             .disk_bytes = now.map.disk_bytes,
             .on_disk = now.map.on_disk,
             .age_s = age_s(now.map.punctuality.last_ns, now.now_ns)};
}

void fill_station_figures(const StationSnapshot& now, const StationSnapshot& before, ServiceStatus& out) {
  ipc::copy_text("base-station", out.role, sizeof(out.role));
  SensorStatus& barometer = out.add_sensor("barometer");
  barometer.heard = now.station.samples > 0;
  barometer.rate_hz =
      per_second(now.station.samples, before.station.samples, elapsed(before.now_ns, now.now_ns));
  barometer.age_s = age_s(now.station.cadence.last_ns(), now.now_ns);
  fill_timing(now.station.arrivals.figures(now.now_ns), barometer);
  barometer.samples = now.station.samples;
  barometer.lost = now.input.counters.lost[static_cast<std::size_t>(Kind::kPressure)];
  barometer.rejected = now.barometer.device.counters.implausible +
                       now.input.refused[static_cast<std::size_t>(Kind::kPressure)] +
                       now.input.counters.malformed + now.input.counters.implausible;
  barometer.dropped = now.station.dropped_samples + now.station.samples_without_memory;
}

}  // namespace isobar
