// SPDX-License-Identifier: BSD-3-Clause
// A graph of stages as the main thread sees it, and the loop that supervises it.
#pragma once

#include <cstdint>
#include <string>

#include "config/config.hpp"
#include "daemon/service.hpp"
#include "daemon/worker_group.hpp"
#include "drivers/barometer/barometer_device.hpp"
#include "ipc/topics.hpp"

namespace isobar {

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
  [[nodiscard]] virtual BarometerState barometer_state() const = 0;
  /// Adds the health entries of all stages. Rates and growth of counters refer to the time since the last
  /// call.
  /// @param now_ns robot clock
  virtual void fill_health(std::int64_t now_ns, ipc::HealthReport& report) = 0;
};

/// Runs the graph until a stop signal: start, supervise (health report, watchdog, level changes to the log),
/// stop. Real-time settings that the system refuses become warnings in the health report; the graph runs
/// without them, with more latency jitter.
/// @throws ServiceError when the files of the run cannot be written
/// @throws std::system_error when the kernel refuses a thread
void run(Graph& graph, Service& service, const RealtimeSettings& realtime);

}  // namespace isobar
