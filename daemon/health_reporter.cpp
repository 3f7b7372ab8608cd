// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_reporter.hpp"

#include "daemon/health_entries.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

bool HealthReporter::fill(std::int64_t now_ns, ipc::HealthReport& report) {
  const bool alive = graph_.workers().all_alive(now_ns);
  const std::uint64_t faults = ipc::library_fault_count();
  report.stamp_ns = now_ns;
  report.robot_clock_offset_ns = RobotClock::offset_ns();
  // Threads first: a full report drops the entries that come last.
  graph_.workers().fill(report);
  add_library_faults(report, faults, last_faults_);
  graph_.fill_health(now_ns, report);
  add_refusals(report, refusals_);
  last_faults_ = faults;
  return alive;
}

}  // namespace isobar
