// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_reporter.hpp"

#include "core/stamp.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_summary.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

bool HealthReporter::fill(std::int64_t now_ns, ipc::HealthReport& report) {
  const bool alive = graph_.workers().all_alive(now_ns);
  const std::uint64_t faults = ipc::library_fault_count();
  report.stamp_ns = now_ns;
  report.robot_clock_offset_ns = RobotClock::offset_ns();
  if (started_ns_ == 0) started_ns_ = now_ns;
  report.status.uptime_s = seconds_between(started_ns_, now_ns);
  reserve_summary(report);
  // Threads first: a full report drops the entries that come last.
  graph_.workers().fill(report);
  add_library_faults(report, faults, last_faults_);
  add_missing_files(report, ipc::check_broker_files());
  graph_.fill_health(now_ns, report);
  for (const HealthSource& source : graph_.health_sources()) source(now_ns, report);
  add_refusals(report, refusals_);
  hold_.apply(now_ns, report);
  fill_summary(report);
  last_faults_ = faults;
  return alive;
}

}  // namespace isobar
