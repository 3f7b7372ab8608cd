// SPDX-License-Identifier: BSD-3-Clause
// isobard as a base station: the whole graph on one screen.
//
//   barometer ─ samples ─▶ station ─ samples with their noise ─▶ isobar-dds ──▶ DDS ──▶ all robots
//
// The same programs, topics in shared memory and health as on a robot; nothing here knows of robots.
#include "daemon/base_station.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <memory>
#include <optional>

#include "daemon/barometer_source.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/inertial_thread.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/station_thread.hpp"
#include "daemon/worker_watch.hpp"

namespace isobar {
namespace {

using ipc::HealthLevel;

/// What the threads said of themselves at one moment.
struct StationSnapshot {
  std::int64_t now_ns = 0;
  InertialStatus input;
  BarometerThreadStatus barometer;
  StationStatus station;
};

void add_barometer(const StationSnapshot& now, const StationSnapshot& before, const Config& config,
                   ipc::HealthReport& report) {
  const StationStatus& station = now.station;
  const auto stuck_ns = static_cast<std::int64_t>(config.prior.altimeter.stuck_timeout_s * 1e9);
  const double elapsed_s = static_cast<double>(now.now_ns - before.now_ns) * 1e-9;
  const double rate_hz = per_second(station.samples, before.station.samples, elapsed_s);
  const std::int64_t unchanged_ns = station.cadence.last_ns() - station.changed_ns;
  if (now.barometer.present) {
    add_barometer_device(report, config.barometer, now.barometer, before.barometer, now.now_ns, rate_hz);
  } else if (unchanged_ns > stuck_ns && !station.cadence.silent(now.now_ns)) {
    report.add("barometer", HealthLevel::kError,
               fmt::format("stuck: {:.3f} Pa for {:.0f} s", station.newest.pressure_pa,
                           static_cast<double>(unchanged_ns) * 1e-9),
               0.0);
  } else {
    add_stream(report, "barometer", station.cadence.last_ns(), now.now_ns, station.cadence.limit_ns(),
               rate_hz, "UDP port " + std::to_string(config.input.port));
  }
  if (station.samples == 0) return;
  report.add("barometer/pressure", HealthLevel::kOk, "Pa", station.newest.pressure_pa);
  if (!std::isnan(station.newest.temperature_c)) {
    report.add("barometer/temperature", HealthLevel::kOk, "degrees C, of the sensor",
               station.newest.temperature_c);
  }
  if (!std::isnan(station.newest.variance_pa2)) {
    report.add("barometer/noise", HealthLevel::kOk, "Pa, standard deviation of a sample",
               std::sqrt(station.newest.variance_pa2));
  }
}

void fill(const StationSnapshot& now, const StationSnapshot& before, const Config& config,
          const std::vector<std::string>& refusals, ipc::HealthReport& report) {
  constexpr auto kBarometer = static_cast<std::size_t>(datagram::Kind::kPressure);
  report.stamp_ns = now.now_ns;
  add_barometer(now, before, config, report);
  add_count(report, "barometer/lost", now.input.counters.lost[kBarometer],
            before.input.counters.lost[kBarometer], "samples missing, by their numbers");
  add_count(report, "station/dropped", now.station.dropped_samples, before.station.dropped_samples,
            "samples that came faster than they could be used");
  add_count(report, "station/no_memory", now.station.samples_without_memory,
            before.station.samples_without_memory, "samples dropped: no free chunk of shared memory");
  add_calibration(report, "barometer", now.station.outside_calibration, before.station.outside_calibration,
                  now.station.without_temperature, before.station.without_temperature);
  add_input(report, now.input, before.input);
  add_refusals(report, refusals);
}

}  // namespace

void run_base_station(const Config& config, Service& service) {
  const int priority = config.realtime.enabled ? config.realtime.inertial_priority : 0;
  const ThreadSettings for_input{"input", priority, config.realtime.estimator_cpus};
  const ThreadSettings for_barometer{"barometer", priority, config.realtime.estimator_cpus};
  const ThreadSettings for_station{"station", priority, config.realtime.estimator_cpus};
  std::vector<std::string> refusals = try_settings({for_input, for_barometer, for_station});
  if (config.realtime.enabled) {
    if (std::string refusal = lock_memory(); !refusal.empty()) refusals.push_back(std::move(refusal));
  }

  ipc::Broker broker;
  StationThread station(config.prior.altimeter, config.prior.compensation, for_station);
  std::unique_ptr<BarometerDevice> device = make_barometer(config.barometer);
  InertialThread input(config.input.address, config.input.port,
                       {.barometer = device == nullptr, .others = false}, for_input);
  std::optional<BarometerThread> barometer;
  if (device) barometer.emplace(std::move(device), for_barometer);
  station.start();
  input.start();
  if (barometer) barometer->start();
  spdlog::info("ready: base station \"{}\", samples on UDP port {}", config.dds.base_station, input.port());

  const auto look = [&] {
    return StationSnapshot{RobotClock::now_ns(), input.status(),
                           barometer ? barometer->status() : BarometerThreadStatus{}, station.status()};
  };
  WorkerWatch watch;
  watch.add("input", input);
  if (barometer) watch.add("barometer", *barometer);
  watch.add("station", station);
  StationSnapshot before = look();
  LevelChanges changes;
  ipc::Publisher<ipc::HealthReport> health(ipc::topics::kHealth);
  service.ready();
  service.supervise([&] {
    const StationSnapshot now = look();
    const bool failed_or_back = now.barometer.device.state != before.barometer.device.state;
    if (now.now_ns - before.now_ns < kReportEveryNs && !failed_or_back) return false;
    const bool alive = watch.all_alive(now.now_ns);
    ipc::HealthReport report;
    fill(now, before, config, refusals, report);
    watch.fill(report);
    before = now;
    health.send(report);
    for (const std::string& line : news(report, changes)) spdlog::info("{}", line);
    return alive;
  });
  spdlog::info("stopping");
  input.stop();
  if (barometer) barometer->stop();
  station.stop();
}

}  // namespace isobar
