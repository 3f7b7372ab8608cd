// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/graph.hpp"

#include <spdlog/spdlog.h>

#include <chrono>

#include "daemon/health_entries.hpp"
#include "daemon/health_reporter.hpp"
#include "daemon/input_health.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/logging.hpp"
#include "daemon/pulse_supervisor.hpp"
#include "daemon/realtime.hpp"
#include "daemon/report_schedule.hpp"
#include "daemon/waiting_log.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {
namespace {

std::vector<std::string> refusals_of(const WorkerGroup& workers, const RealtimeSettings& realtime) {
  std::vector<std::string> refusals = workers.refused_settings();
  if (realtime.enabled) {
    if (std::string refusal = lock_memory(); !refusal.empty()) refusals.push_back(std::move(refusal));
  }
  return refusals;
}

/// A lidar at 10 Hz is silent after 250 ms; the report about it is due within 300 ms of its last packet.
constexpr std::chrono::milliseconds kTick{25};

/// The supervise loop: publishes health reports, logs level changes, and feeds the watchdog while no thread
/// hangs.
void supervise(Graph& graph, Service& service, Configuration& configuration,
               std::vector<std::string> realtime_refusals) {
  SystemClockWatch system_clock(RobotClock::offset_ns());
  graph.add_health([&system_clock](std::int64_t now_ns, ipc::HealthReport& report) {
    report.system_clock_ahead_ns = system_clock.ahead_ns();
    add_system_clock(report, system_clock, now_ns);
  });
  PulseSupervisor pulses(configuration.config().pps);
  graph.add_health([&pulses](std::int64_t /*now_ns*/, ipc::HealthReport& report) { pulses.fill(report); });
  HealthReporter reporter(graph, std::move(realtime_refusals));
  ReportSchedule schedule;
  LevelChanges known;
  WaitingLog waiting;
  ipc::Publisher<ipc::HealthReport> publisher(ipc::topics::kHealth);
  service.ready(configuration.status());
  service.supervise(
      [&] {
        const std::int64_t now_ns = RobotClock::now_ns();
        const ClockPair clocks = read_clocks();
        pulses.poll(clocks);
        if (const std::int64_t step_ns = system_clock.note(clocks); step_ns != 0) {
          spdlog::warn("{}", step_text(step_ns));
        }
        configuration.poll(graph, service);
        graph.collect();
        if (!schedule.due(now_ns, graph.device_states(), graph.lidar_is_silent(now_ns))) return false;
        ipc::HealthReport report;
        const bool alive = reporter.fill(now_ns, report);
        publisher.send(report);
        for (const LevelChange& change : level_changes(report, known)) log_change(change);
        for (const std::string& line : waiting.due(graph.waiting_for(), now_ns)) spdlog::warn("{}", line);
        return alive;
      },
      kTick);
}

}  // namespace

void run(Graph& graph, Service& service, Configuration& configuration) {
  std::vector<std::string> refusals = refusals_of(graph.workers(), configuration.config().realtime);
  graph.add_health(
      [&configuration](std::int64_t /*now_ns*/, ipc::HealthReport& report) { configuration.fill(report); });
  graph.start();
  spdlog::info("ready: {}", graph.inputs());
  supervise(graph, service, configuration, std::move(refusals));
  spdlog::info("stopping");
  graph.stop();
}

}  // namespace isobar
