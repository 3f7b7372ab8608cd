// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_health.hpp"

#include <spdlog/fmt/fmt.h>

#include <string>

#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {
namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

void add_session(const StatusSnapshot& now, HealthReport& report) {
  const RegistrationStatus& registration = now.registration;
  std::string message = "frame map";
  if (registration.session > 1) message += fmt::format("_{}", registration.session);
  if (registration.searching) message += ": the scans do not confirm the place of the last run yet";
  if (registration.session_reason != NewFrameReason::kNone) {
    message += fmt::format(": begun because of: {}", kNewFrameReasonNames.name(registration.session_reason));
  }
  const bool unknown = registration.session_reason == NewFrameReason::kPlaceUnknown;
  const std::int64_t last_ns = registration.punctuality.last_ns;
  const bool stale = last_ns == 0 || now.now_ns - last_ns > kStageSilenceNs;
  const HealthLevel level = stale                               ? HealthLevel::kStale
                            : unknown || registration.searching ? HealthLevel::kWarning
                                                                : HealthLevel::kOk;
  add_entry(report, "session", level, message, registration.session);
}

void add_disk(const StatusSnapshot& now, HealthReport& report) {
  if (!now.output.present) return;
  const bool failing = now.output.failing || now.map.disk_failing;
  const char* reason = now.output.failing ? now.output.reason.data() : "tiles of the map are refused";
  add_entry(report, "disk", failing ? HealthLevel::kError : HealthLevel::kOk,
            failing ? reason : "poses and map are written; poses lost to the disk",
            static_cast<double>(now.output.dropped_lines));
}

}  // namespace

void add_run_entries(const StatusSnapshot& now, HealthReport& report) {
  add_session(now, report);
  add_disk(now, report);
}

}  // namespace isobar
