// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/graph.hpp"
#include "daemon/run_description.hpp"
#include "daemon/sample_thread.hpp"
#include "daemon/scheduling.hpp"
#include "daemon/station_health.hpp"
#include "daemon/station_thread.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// The graph of a base station.
class BaseStationGraph final : public Graph {
 public:
  /// @throws ServiceError when the port cannot be bound or shared memory is refused
  /// @param configuration its name in the description of the run
  BaseStationGraph(const Config& config, const std::string& configuration);

  void start() override { workers_.start(); }
  void stop() override { workers_.stop(); }
  [[nodiscard]] StationSnapshot status(std::int64_t now_ns) const;

  [[nodiscard]] WorkerGroup& workers() override { return workers_; }
  [[nodiscard]] std::string inputs() const override;
  [[nodiscard]] DeviceStates device_states() const override;
  [[nodiscard]] std::vector<std::string> waiting_for() const override;
  void fill_health(std::int64_t now_ns, ipc::HealthReport& report) override;
  /// isobar-dds follows at once. All else waits: a base station starts in a second and has no state to lose.
  [[nodiscard]] Apply apply_of(const Setting& setting) const override {
    return setting.key.starts_with("dds.") ? setting.apply : Apply::kRestart;
  }
  void apply(const ConfigChange& change) override;

 private:
  Config config_;
  BaseStationScheduling scheduling_;
  ipc::Broker broker_;
  RunDescriptionPublisher description_;
  StationThread station_;
  std::unique_ptr<BarometerThread> barometer_;
  SampleThread input_;
  StationSnapshot last_report_;
  WorkerGroup workers_;  ///< last: stops all threads before the stages are destroyed
};

}  // namespace isobar
