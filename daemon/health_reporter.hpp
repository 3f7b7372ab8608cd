// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/graph.hpp"
#include "daemon/health_summary.hpp"

namespace isobar {

/// Composes the health report of a graph. Main thread.
class HealthReporter {
 public:
  /// @param realtime_refusals one sentence for each real-time setting that the system refused
  HealthReporter(Graph& graph, std::vector<std::string> realtime_refusals)
      : graph_(graph), refusals_(std::move(realtime_refusals)) {}

  /// Checks the heartbeats and fills an empty report.
  /// @param now_ns robot clock
  /// @return true when all threads are alive
  bool fill(std::int64_t now_ns, ipc::HealthReport& report);

 private:
  Graph& graph_;
  std::vector<std::string> refusals_;
  LevelHold hold_;
  std::int64_t started_ns_ = 0;  // robot clock, at the first report
  std::uint64_t last_faults_ = 0;
};

}  // namespace isobar
