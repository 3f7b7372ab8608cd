// SPDX-License-Identifier: BSD-3-Clause
// A graph of stages as the main thread sees it, and the loop that supervises it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "config/config.hpp"
#include "config/config_change.hpp"
#include "daemon/configuration.hpp"
#include "daemon/report_schedule.hpp"
#include "daemon/service.hpp"
#include "daemon/worker_group.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Adds health entries to a report; now_ns: robot clock. Main thread.
using HealthSource = std::function<void(std::int64_t now_ns, ipc::HealthReport& report)>;

/// The stages of one role of isobard, constructed but not started. Main thread only.
class Graph {
 public:
  Graph() = default;
  virtual ~Graph() = default;
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  /// Starts all threads, consumers first.
  /// @throws std::system_error when the kernel refuses a thread
  virtual void start() = 0;
  /// Stops and joins all threads, producers first, then closes the files of the run.
  /// @throws ServiceError when the disk refuses
  virtual void stop() = 0;
  [[nodiscard]] virtual WorkerGroup& workers() = 0;
  /// Inputs in one line, for the log.
  [[nodiscard]] virtual std::string inputs() const = 0;
  /// State of the barometer attached to this machine, whose changes are reported at once; kStarting if
  /// there is none.
  [[nodiscard]] virtual DeviceStates device_states() const = 0;
  /// Whether a lidar that was heard sends no longer, which is reported at once, as is its return.
  [[nodiscard]] virtual bool lidar_is_silent(std::int64_t /*now_ns*/) const { return false; }
  /// What the inputs wait for, a sentence each; empty texts: nothing.
  [[nodiscard]] virtual std::vector<std::string> waiting_for() const { return {}; }
  /// Adds the health entries of all stages. Rates and growth of counters refer to the time since the last
  /// call.
  /// @param now_ns robot clock
  virtual void fill_health(std::int64_t now_ns, ipc::HealthReport& report) = 0;

  /// When this graph can apply a changed setting while it runs.
  [[nodiscard]] virtual Apply apply_of(const Setting& setting) const = 0;
  /// Hands the live and stage keys of a change to their stages; poses go on.
  /// @throws ConfigError, ServiceError when a stage refuses; nothing has then changed
  virtual void apply(const ConfigChange& change) = 0;
  /// Frees what the stages no longer need. Every tick of the supervise loop.
  virtual void collect() {}

  /// Adds entries of a part of the program that is no stage, such as the configuration or the disk; called
  /// for each report, after fill_health():
  ///
  ///     graph.add_health([&](std::int64_t now_ns, ipc::HealthReport& report) {
  ///       add_entry(report, "configuration", ipc::HealthLevel::kOk, "in force", 0.0);
  ///     });
  void add_health(HealthSource source) { sources_.push_back(std::move(source)); }
  [[nodiscard]] const std::vector<HealthSource>& health_sources() const { return sources_; }

 private:
  std::vector<HealthSource> sources_;
};

/// Runs the graph until a stop signal: start, supervise (health report, watchdog, level changes to the log,
/// changed configurations), stop. Real-time settings that the system refuses become warnings in the health report; the graph runs
/// without them, with more latency jitter.
/// @throws ServiceError when the files of the run cannot be written
/// @throws std::system_error when the kernel refuses a thread
void run(Graph& graph, Service& service, Configuration& configuration);

}  // namespace isobar
