// SPDX-License-Identifier: BSD-3-Clause
// isobard: the whole graph of a robot on one screen. (The base station's is in base_station.cpp.)
//
//   lidar ──packets→scan──────────────┐                    ┌─▶ poses ──▶ isobar-dds ──▶ DDS
//   imu ─┐                            ▼                    │
//   baro ├─ samples ─▶ prior ─ priors ─▶ registration ─────┤
//   wheel┤                               ▲                 └─▶ registered scans ─▶ map
//   base ┘                               └────────────────────── snapshots ─────────┘
//
// Registered scans also go to loops, which corrects map and trajectory by places that are seen again, and to place, which
// searches a robot that does not know its place in the whole map; poses and points of the map to floors, which tells the
// floor and makes its grid.
//
// Every arrow is a topic in shared memory (ipc/topics.hpp), except the snapshot, which stays inside the
// process.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "config/problems.hpp"
#include "core/errors.hpp"
#include "daemon/barometer_source.hpp"
#include "daemon/base_station.hpp"
#include "daemon/black_box.hpp"
#include "daemon/broker_patience.hpp"
#include "daemon/check_thread.hpp"
#include "daemon/configuration.hpp"
#include "daemon/contradictions.hpp"
#include "daemon/floor_thread.hpp"
#include "daemon/graph.hpp"
#include "daemon/health.hpp"
#include "daemon/imu_source.hpp"
#include "daemon/input_health.hpp"
#include "daemon/lidar_thread.hpp"
#include "daemon/logging.hpp"
#include "daemon/loop_thread.hpp"
#include "daemon/map_thread.hpp"
#include "daemon/missing_sensors.hpp"
#include "daemon/options.hpp"
#include "daemon/output_thread.hpp"
#include "daemon/place_thread.hpp"
#include "daemon/prior_thread.hpp"
#include "daemon/registration_thread.hpp"
#include "daemon/run_description.hpp"
#include "daemon/run_files.hpp"
#include "daemon/sample_thread.hpp"
#include "daemon/scheduling.hpp"
#include "daemon/service_folder.hpp"
#include "daemon/stage_settings.hpp"
#include "daemon/wheel_source.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {

namespace {

/// The graph of a robot.
class RobotGraph final : public Graph {
 public:
  /// @throws ConfigError, ServiceError when a port, a device, shared memory or a folder is refused
  /// @param configuration its name in the description of the run
  RobotGraph(const Config& config, const std::string& configuration)
      : config_(config),
        stages_(stage_settings(config)),
        scheduling_(robot_scheduling(config.realtime)),
        description_(config, configuration),
        black_box_(black_box::BlackBox::make(config)),
        files_(config),
        map_(stages_.map, stages_.T_base_lidar, config.output.cloud_interval_s, files_.maps(), files_.start(),
             scheduling_.map, config.floors.enabled ? &floor_feed_ : nullptr),
        registration_(stages_, map_.snapshots(), scan_queue_config(config.realtime),
                      scheduling_.registration),
        prior_(stages_.prior, scheduling_.prior),
        imu_(make_imu_thread(config, scheduling_.imu)),
        barometer_(make_barometer_thread(config.barometer, scheduling_.barometer)),
        wheels_(make_wheel_thread(config.wheel, scheduling_.wheels)),
        samples_(config.input.address, config.input.port,
                 {.imu = config.imu.source == ImuSource::kDatagram,
                  .barometer = config.barometer.source == BarometerSource::kDatagram,
                  .wheel = config.wheel.source == WheelSource::kDatagram,
                  .unsigned_base = config.dds.keys_directory.empty()},
                 config.input.senders, scheduling_.inertial),
        lidar_(config.lidar.source == LidarSource::kDriver
                   ? std::make_unique<LidarThread>(stages_, config.lidar, scheduling_.lidar)
                   : nullptr),
        check_({.imu = imu_mount(config), .lidar = config.lidar.mount}, config.imu.present(),
               scheduling_.check),
        loops_(config.loops.enabled && files_.output() != nullptr && !files_.stays()
                   ? std::make_unique<LoopThread>(stages_, files_.loop_files(config), map_, scheduling_.loops)
                   : nullptr),
        place_(stages_, files_, map_, registration_, scheduling_.place),
        floors_(config.floors.enabled ? std::make_unique<FloorThread>(config.floors, floor_feed_,
                                                                      files_.map_folder(), scheduling_.floors)
                                      : nullptr),
        output_(files_.checkpoint_file().empty()
                    ? nullptr
                    : std::make_unique<OutputThread>(
                          files_, [this] { return prior_.status().datum; }, scheduling_.output)),
        monitor_(config) {
    registration_.begin_at(files_.start());
    registration_.wait_for_place();
    if (files_.stays()) registration_.stay_in(*files_.start().place);
    prior_.resume(files_.start().datum);
    // Start order: consumers first. The output thread is not watched: it may wait for a disk, and poses
    // continue without it.
    if (black_box_) black_box_->add_to(workers_);
    if (output_) workers_.add(output_->worker(), Watch::kNo);
    workers_.add(check_.worker(), Watch::kNo);
    if (loops_) workers_.add(loops_->worker(), Watch::kNo);
    workers_.add(place_.worker(), Watch::kNo);
    if (floors_) workers_.add(floors_->worker(), Watch::kNo);
    workers_.add(map_.worker());
    workers_.add(registration_.worker());
    workers_.add(prior_.worker());
    workers_.add(samples_.worker());
    // Not watched: they can hang only in the kernel, which a restart does not cure. Poses continue.
    if (imu_) workers_.add(imu_->worker(), Watch::kNo);
    if (barometer_) workers_.add(barometer_->worker(), Watch::kNo);
    if (wheels_) workers_.add(wheels_->worker(), Watch::kNo);
    if (lidar_) workers_.add(lidar_->worker());
  }

  void start() override {
    for (const std::string& text : missing_sensor_texts(present_sensors(config_))) spdlog::info("{}", text);
    workers_.start();
  }
  void stop() override {
    workers_.stop();
    files_.close(status(RobotClock::now_ns()), loops_ ? &loops_->stage() : nullptr);
  }
  [[nodiscard]] StatusSnapshot status(std::int64_t now_ns) const {
    const RegistrationStatus registration = registration_.status();
    return {now_ns,
            lidar_ ? lidar_->status()
                   : status_of_clouds(registration.arrived_scans, registration.last_scan_ns,
                                      registration.scan_arrivals),
            samples_.status(),
            imu_ ? imu_->status() : DeviceThreadStatus{},
            barometer_ ? barometer_->status() : DeviceThreadStatus{},
            wheels_ ? wheels_->status() : DeviceThreadStatus{},
            prior_.status(),
            registration,
            map_.status(),
            output_ ? output_->status() : OutputStatus{},
            lidar_ ? lidar_->waiting_for() : std::string{},
            lidar_ ? lidar_->info_waiting_for() : std::string{},
            samples_.waiting_for(),
            check_.findings(),
            place_.status(),
            files_.start().other_station};
  }

  [[nodiscard]] WorkerGroup& workers() override { return workers_; }
  [[nodiscard]] std::string inputs() const override {
    const std::string lidar =
        lidar_ ? fmt::format("{} on UDP port {}", config_.lidar.model, lidar_->port()) : "clouds over DDS";
    return fmt::format("lidar {}, samples on UDP port {}", lidar, samples_.port());
  }
  [[nodiscard]] DeviceStates device_states() const override {
    return {barometer_ ? barometer_->status().device.state : DeviceState{},
            imu_ ? imu_->status().device.state : DeviceState{},
            wheels_ ? wheels_->status().device.state : DeviceState{}};
  }
  [[nodiscard]] bool lidar_is_silent(std::int64_t now_ns) const override {
    return lidar_ && is_silent(lidar_->status(), now_ns);
  }
  [[nodiscard]] std::vector<std::string> waiting_for() const override {
    return {lidar_ ? lidar_->waiting_for() : std::string{}, samples_.waiting_for(),
            imu_ ? isobar::waiting_for(imu_->status()) : std::string{},
            barometer_ ? isobar::waiting_for(barometer_->status()) : std::string{},
            wheels_ ? isobar::waiting_for(wheels_->status()) : std::string{}};
  }
  void fill_health(std::int64_t now_ns, ipc::HealthReport& report) override {
    monitor_.fill(status(now_ns), report);
    if (floors_) add_floor(floors_->status(), report);
    if (black_box_) black_box_->fill_health(report);
  }
  [[nodiscard]] Apply apply_of(const Setting& setting) const override { return setting.apply; }
  void apply(const ConfigChange& change) override {
    config_ = change.running;
    stages_ = stage_settings(without_unusable(config_, usable_));
    const RobotScheduling scheduling = robot_scheduling(config_.realtime);
    if (lidar_) lidar_->configure(stages_.lidar.limits, scheduling.lidar.deadline_ms);
    if (usable_ == UsableSensors{}) {
      prior_.configure(stages_.prior, scheduling.prior.deadline_ms);
    } else {
      prior_.leave_out(stages_.prior, usable_, scheduling.prior.deadline_ms);
    }
    if (change.concerns("method") || change.concerns("registration.") || change.concerns("realtime.")) {
      registration_.rebuild(stages_, scan_queue_config(config_.realtime),
                            scheduling.registration.deadline_ms);
    }
    map_.configure(stages_.map, config_.output.cloud_interval_s, scheduling.map.deadline_ms);
    monitor_.configure(without_unusable(config_, usable_));
    description_.publish(config_);
  }
  void collect() override {
    if (monitor_.input_starts_over(lidar_ ? lidar_->status() : LidarStatus{}, samples_.status(),
                                   prior_.status())) {
      registration_.begin_new_frame(NewFrameReason::kInputStartsOver);
    }
    leave_out(usable_sensors(check_.findings()));
    if (lidar_) lidar_->collect();
    prior_.collect();
    registration_.collect();
    map_.collect();
  }

 private:
  /// Goes on, in a new map frame, without what contradicts: the map so far may be turned by it.
  void leave_out(const UsableSensors& usable) {
    if (usable == usable_) return;
    usable_ = usable;
    stages_ = stage_settings(without_unusable(config_, usable_));
    const RobotScheduling scheduling = robot_scheduling(config_.realtime);
    prior_.leave_out(stages_.prior, usable_, scheduling.prior.deadline_ms);
    registration_.rebuild(stages_, scan_queue_config(config_.realtime), scheduling.registration.deadline_ms);
    registration_.begin_new_frame(NewFrameReason::kContradiction);
    monitor_.configure(without_unusable(config_, usable_));
  }

  Config config_;
  UsableSensors usable_;  ///< the sensors that the stages use
  StageSettings stages_;
  RobotScheduling scheduling_;
  ipc::Broker broker_;
  RunDescriptionPublisher description_;
  std::unique_ptr<black_box::BlackBox> black_box_;
  RunFiles files_;
  FloorFeed floor_feed_;
  MapThread map_;
  RegistrationThread registration_;
  PriorThread prior_;
  std::unique_ptr<ImuThread> imu_;
  std::unique_ptr<BarometerThread> barometer_;
  std::unique_ptr<WheelThread> wheels_;
  SampleThread samples_;
  std::unique_ptr<LidarThread> lidar_;  ///< null: the scans come from isobar-dds
  CheckThread check_;
  std::unique_ptr<LoopThread> loops_;  ///< null: switched off, or no folder for what it finds
  PlaceThread place_;
  std::unique_ptr<FloorThread> floors_;  ///< null: switched off
  std::unique_ptr<OutputThread> output_;
  HealthMonitor monitor_;
  WorkerGroup workers_;  ///< last: stops all threads before the stages are destroyed
};

int main_with_errors(int argc, char** argv) {
  CLI::App app;
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    app.exit(error);
    return asked_for_help ? 0 : 64;
  }
  // Before the first thread, so that all threads inherit the blocked signals.
  Service service;
  black_box::block_save_signal();
  wait_for_shared_memory(service);
  Configuration configuration(
      options.config_file,
      [&options](Config& config) {
        if (!options.output_directory.empty()) config.output.directory = options.output_directory;
      },
      service_folder("STATE_DIRECTORY"));
  const Config& config = configuration.config();
  if (config.role == Role::kBaseStation) {
    if (!options.output_directory.empty()) throw UsageError("--output: a base station writes no run");
    BaseStationGraph graph(config, configuration.name());
    run(graph, service, configuration);
    return 0;
  }
  RobotGraph graph(config, configuration.name());
  run(graph, service, configuration);
  return 0;
}

}  // namespace

}  // namespace isobar

int main(int argc, char** argv) {
  isobar::set_up_logging("isobard");
  try {
    return isobar::main_with_errors(argc, argv);
  } catch (const isobar::ConfigErrors& errors) {
    for (const std::string& problem : errors.all()) spdlog::error("{}", problem);
    return errors.exit_code();
  } catch (const isobar::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    spdlog::error("unexpected: {}", error.what());
    return 70;
  }
}
