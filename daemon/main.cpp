// SPDX-License-Identifier: BSD-3-Clause
// isobard: the whole graph on one screen. (A base station's is in base_station.cpp.)
//
//   lidar ──packets→scan──────────────┐                    ┌─▶ poses ──▶ isobar-dds ──▶ DDS
//   imu ─┐                            ▼                    │
//   baro ├─ samples ─▶ prior ─ priors ─▶ registration ─────┤
//   wheel┤                               ▲                 └─▶ registered scans ─▶ map
//   base ┘                               └────────────────────── snapshots ─────────┘
//
// Every arrow is a topic in shared memory (ipc/topics.hpp); only the snapshot is handed over inside the
// process.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <optional>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "daemon/barometer_source.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/base_station.hpp"
#include "daemon/counts.hpp"
#include "daemon/health.hpp"
#include "daemon/inertial_thread.hpp"
#include "daemon/lidar_thread.hpp"
#include "daemon/logging.hpp"
#include "daemon/map_thread.hpp"
#include "daemon/output_thread.hpp"
#include "daemon/prior_thread.hpp"
#include "daemon/registration_thread.hpp"
#include "daemon/service.hpp"
#include "daemon/stage_settings.hpp"
#include "daemon/worker_watch.hpp"

namespace isobar {

namespace {

/// How each thread is scheduled and when it is late; the figures are in the configuration, [realtime].
struct Scheduling {
  ThreadSettings lidar, inertial, barometer, prior, registration, map, output;
};

Scheduling scheduling_of(const RealtimeSettings& realtime) {
  const auto fifo = [&](int priority) { return realtime.enabled ? priority : 0; };
  return {
      {"lidar", fifo(realtime.lidar_priority), realtime.estimator_cpus, realtime.lidar_deadline_ms},
      {"inertial", fifo(realtime.inertial_priority), realtime.estimator_cpus},
      {"barometer", fifo(realtime.inertial_priority), realtime.estimator_cpus},
      {"prior", fifo(realtime.prior_priority), realtime.estimator_cpus, realtime.prior_deadline_ms},
      {"registration", fifo(realtime.registration_priority), realtime.estimator_cpus,
       realtime.registration_deadline_ms},
      {"map", 0, realtime.map_cpus, realtime.map_deadline_ms},
      {"output", 0, {}},
  };
}

ScanQueueConfig scan_queue_of(const RealtimeSettings& realtime) {
  return {static_cast<std::int64_t>(realtime.prior_reach_ms * 1e6),
          static_cast<std::int64_t>(realtime.prior_wait_ms * 1e6)};
}

/// What the system refuses of the scheduling, for the health report: a robot drives without it, only less
/// evenly.
std::vector<std::string> refusals_of(const Scheduling& scheduling, bool realtime) {
  std::vector<std::string> refusals =
      try_settings({scheduling.lidar, scheduling.inertial, scheduling.barometer, scheduling.prior,
                    scheduling.registration, scheduling.map, scheduling.output});
  if (realtime) {
    if (std::string refusal = lock_memory(); !refusal.empty()) refusals.push_back(std::move(refusal));
  }
  return refusals;
}

/// Where tiles go that are too far from the robot for memory; null where nothing is written.
std::unique_ptr<FileTileStore> map_store(const Config& config) {
  std::filesystem::path directory = config.map_files.directory;
  if (directory.empty() && !config.output.directory.empty()) {
    directory = files::RunOutput::map_directory(config.output.directory);
  }
  if (directory.empty()) return nullptr;
  return FileTileStore::create(directory, map_header(config), map_limits(config));
}

void run_robot(const Config& config, Service& service) {
  const StageSettings stages = stage_settings(config);
  const Scheduling scheduling = scheduling_of(config.realtime);
  const std::vector<std::string> refusals = refusals_of(scheduling, config.realtime.enabled);

  ipc::Broker broker;
  std::optional<files::RunOutput> output;
  if (!config.output.directory.empty()) {
    output.emplace(config.output.directory);
    output->write_settings(show_config(config));
  }

  const std::unique_ptr<FileTileStore> store = map_store(config);
  MapThread map(stages.map, stages.T_base_lidar, config.output.cloud_interval_s, store.get(), scheduling.map);
  RegistrationThread registration(stages.registration, stages.method, stages.T_base_lidar, map.snapshots(),
                                  scan_queue_of(config.realtime), scheduling.registration);
  PriorThread prior(stages.prior, scheduling.prior);
  std::unique_ptr<BarometerDevice> device = make_barometer(config.barometer);
  InertialThread inertial(config.input.address, config.input.port, {.barometer = device == nullptr},
                          scheduling.inertial);
  std::optional<BarometerThread> barometer;
  if (device) barometer.emplace(std::move(device), scheduling.barometer);
  LidarThread lidar(stages.lidar, config.lidar.address, config.lidar.port, scheduling.lidar);
  std::optional<OutputThread> writer;
  if (output) writer.emplace(*output, scheduling.output);

  // Consumers first, so that nothing is produced that nobody takes.
  if (writer) writer->start();
  map.start();
  registration.start();
  prior.start();
  inertial.start();
  if (barometer) barometer->start();
  lidar.start();
  spdlog::info("ready: lidar {} on UDP port {}, samples on UDP port {}", config.lidar.model, lidar.port(),
               inertial.port());

  const auto look = [&] {
    return StatusSnapshot{RobotClock::now_ns(), lidar.status(),
                          inertial.status(),    barometer ? barometer->status() : BarometerThreadStatus{},
                          prior.status(),       registration.status(),
                          map.status()};
  };
  // Not the barometer: if it hangs it does so in the kernel, which no new start mends, and poses go on
  // without.
  WorkerWatch watch;
  watch.add("lidar", lidar);
  watch.add("inertial", inertial);
  watch.add("prior", prior);
  watch.add("registration", registration);
  watch.add("map", map);
  if (writer) watch.add("output", *writer);
  HealthMonitor monitor(config, refusals);
  ipc::Publisher<ipc::HealthReport> health(ipc::topics::kHealth);
  service.ready();
  service.supervise([&] {
    const StatusSnapshot now = look();
    if (!monitor.due(now)) return false;
    const bool alive = watch.all_alive(now.now_ns);
    ipc::HealthReport report;
    monitor.fill(now, report);
    watch.fill(report);
    health.send(report);
    for (const std::string& line : monitor.news(report)) spdlog::info("{}", line);
    return alive;
  });

  spdlog::info("stopping");
  // Producers first: what is on its way still reaches the map and the files.
  lidar.stop();
  inertial.stop();
  if (barometer) barometer->stop();
  prior.stop();
  registration.stop();
  map.stop();
  if (writer) writer->stop();
  if (output) {
    const StatusSnapshot last = look();
    std::vector<files::RunCount> counts =
        counts_of(last.lidar.counters, last.lidar.wrong_model_message.data());
    append(counts, counts_of(last.inertial.counters));
    append(counts, counts_of(last.inertial.base));
    if (last.barometer.present) append(counts, counts_of(last.barometer.device.counters));
    append(counts, {{"baro lines refused", last.inertial.refused_pressure, ""}});
    append(counts, counts_of(last.prior.counters));
    append(counts, counts_of_map(*store, *output));  // with an output there always is a store
    output->close(counts);
    spdlog::info("{} poses and {} map points in {}", output->poses(), output->map_points(),
                 config.output.directory);
  }
}

int main_with_errors(int argc, char** argv) {
  CLI::App app{
      "isobard: pose of a robot from lidar, IMU, wheels and air pressure.\n"
      "Exit codes: 0 stopped by a signal, 64 usage, 69 service unavailable, 78 bad configuration."};
  std::string config_file;
  std::string output_directory;
  app.add_option("--config", config_file,
                 "TOML file; `isobar config show` prints every key with its default");
  app.add_option("--output", output_directory,
                 "folder for trajectory.tum, map.ply, map/, status.csv; overrides [output]");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    app.exit(error);
    return asked_for_help ? 0 : 64;
  }
  // First of all, so that every thread inherits the blocked signals.
  Service service;
  Config config = config_file.empty() ? Config{} : load_config(config_file);
  if (config.role == Role::kBaseStation) {
    if (!output_directory.empty()) throw UsageError("--output: a base station writes no run");
    run_base_station(config, service);
    return 0;
  }
  if (!output_directory.empty()) config.output.directory = output_directory;
  run_robot(config, service);
  return 0;
}

}  // namespace

}  // namespace isobar

int main(int argc, char** argv) {
  isobar::set_up_logging("isobard");
  try {
    return isobar::main_with_errors(argc, argv);
  } catch (const isobar::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    spdlog::error("unexpected: {}", error.what());
    return 70;
  }
}
