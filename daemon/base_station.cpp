// SPDX-License-Identifier: BSD-3-Clause
// isobard as a base station: the whole graph on one screen.
//
//   barometer ─ samples ─▶ station ─ samples with their noise ─▶ isobar-dds ──▶ DDS ──▶ all robots
//
// Programs, shared-memory topics and the type of the health report are the same as on a robot.
#include "daemon/base_station.hpp"

#include <spdlog/fmt/fmt.h>

#include "daemon/barometer_source.hpp"
#include "daemon/input_health.hpp"
#include "daemon/status_figures.hpp"

namespace isobar {

BaseStationGraph::BaseStationGraph(const Config& config, const std::string& configuration)
    : config_(config),
      scheduling_(base_station_scheduling(config.realtime)),
      description_(config, configuration),
      station_(config.prior.altimeter, config.prior.compensation, scheduling_.station),
      barometer_(make_barometer_thread(config.barometer, scheduling_.barometer)),
      input_(config.input.address, config.input.port,
             {.barometer = barometer_ == nullptr, .base_station_only = true}, config.input.senders,
             scheduling_.input) {
  // Start order: consumers first.
  workers_.add(station_.worker());
  workers_.add(input_.worker());
  if (barometer_) workers_.add(barometer_->worker());
}

StationSnapshot BaseStationGraph::status(std::int64_t now_ns) const {
  return {now_ns, input_.status(), barometer_ ? barometer_->status() : BarometerThreadStatus{},
          station_.status(), input_.waiting_for()};
}

std::string BaseStationGraph::inputs() const {
  return fmt::format("base station \"{}\", samples on UDP port {}", config_.dds.base_station, input_.port());
}

std::vector<std::string> BaseStationGraph::waiting_for() const {
  return {input_.waiting_for(), barometer_ ? isobar::waiting_for(barometer_->status()) : std::string{}};
}

DeviceState BaseStationGraph::barometer_state() const {
  return barometer_ ? barometer_->status().device.state : DeviceState{};
}

void BaseStationGraph::apply(const ConfigChange& change) {
  config_ = change.running;
  description_.publish(config_);
}

void BaseStationGraph::fill_health(std::int64_t now_ns, ipc::HealthReport& report) {
  const StationSnapshot now = status(now_ns);
  fill_station_health(now, last_report_, config_, report);
  fill_station_figures(now, last_report_, report.status);
  last_report_ = now;
}

}  // namespace isobar
