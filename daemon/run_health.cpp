// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_health.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cstdint>
#include <string>

#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {
namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

/// Time for which a refused hint is a warning [ns].
constexpr std::int64_t kHintShownNs = 60'000'000'000;

void add_session(const StatusSnapshot& now, HealthReport& report) {
  const RegistrationStatus& registration = now.registration;
  std::string message = "frame map";
  if (registration.session > 1) message += fmt::format("_{}", registration.session);
  if (registration.searching) message += ": the scans do not confirm the place of the last run yet";
  if (registration.session_reason != NewFrameReason::kNone) {
    message += fmt::format(": begun because of: {}", kNewFrameReasonNames.name(registration.session_reason));
  }
  if (registration.map_moves > 0) {
    message += fmt::format("; laid anew {} times after places were seen again", registration.map_moves);
  }
  const bool unknown = registration.session_reason == NewFrameReason::kPlaceUnknown;
  const std::int64_t last_ns = registration.punctuality.last_ns;
  const bool stale = last_ns == 0 || now.now_ns - last_ns > kStageSilenceNs;
  const HealthLevel level = stale                               ? HealthLevel::kStale
                            : unknown || registration.searching ? HealthLevel::kWarning
                                                                : HealthLevel::kOk;
  add_entry(report, "session", level, message, registration.session);
}

/// A refused hint is a warning for a while.
HealthLevel hint_level(const HintReport& hint, std::int64_t now_ns) {
  const bool taken = hint.outcome == HintOutcome::kFound || hint.outcome == HintOutcome::kConfirmed;
  const bool recent = now_ns - hint.stamp_ns < kHintShownNs;
  return hint.is_decided() && !taken && recent ? HealthLevel::kWarning : HealthLevel::kOk;
}

std::string hint_text(const HintReport& hint) {
  std::string text(kHintOutcomeTexts.name(hint.outcome));
  if (hint.radius_m > 0.0) text += fmt::format(" (within {:.1f} m)", hint.radius_m);
  return text + fmt::format("; {:.1f} m from where the robot was", hint.distance_m);
}

void add_hint(const StatusSnapshot& now, HealthReport& report) {
  const RegistrationStatus& registration = now.registration;
  if (registration.bad_hints > 0) {
    add_entry(report, "initial_pose/implausible", HealthLevel::kOk,
              "hints refused: not finite, or no covariance", static_cast<double>(registration.bad_hints));
  }
  if (registration.hint.given == 0) return;
  add_entry(report, "initial_pose", hint_level(registration.hint, now.now_ns), hint_text(registration.hint),
            static_cast<double>(registration.hint.given));
}

/// The search of the place in the whole map: a warning while the place is not known.
void add_place(const StatusSnapshot& now, HealthReport& report) {
  const PlaceStatus& place = now.place;
  if (place.state == PlaceState::kIdle && place.searches == 0) return;
  const bool idle = place.state == PlaceState::kIdle;
  const std::string message =
      idle ? fmt::format("{} searches of the whole map, the last in {:.2f} s", place.searches, place.search_s)
           : place_text(place);
  // A robot that may have been carried away registers as ever: a door that opens is no fault.
  const bool known = idle || (place.carried && place.state != PlaceState::kTold);
  add_entry(report, "place", known ? HealthLevel::kOk : HealthLevel::kWarning, message,
            static_cast<double>(place.hypothesis_count));
}

/// Heights of another base station: a warning until the place is found.
void add_other_station(const StatusSnapshot& now, HealthReport& report) {
  if (now.other_station.empty()) return;
  const bool found = now.registration.mode != PoseMode::kInitializing && !now.registration.searching;
  add_entry(report, "stored_map/base_station", found ? HealthLevel::kOk : HealthLevel::kWarning,
            now.other_station, 0.0);
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

void log_hint(const StatusSnapshot& now, const StatusSnapshot& before) {
  const HintReport& hint = now.registration.hint;
  const HintReport& last = before.registration.hint;
  const bool is_new = hint.is_decided() && (hint.given != last.given || !last.is_decided());
  // The change to a warning has a line of its own.
  const bool has_line = hint_level(hint, now.now_ns) == HealthLevel::kWarning &&
                        hint_level(last, now.now_ns) == HealthLevel::kOk;
  if (is_new && !has_line) spdlog::info("hint of the place: {}", hint_text(hint));
}

void add_run_entries(const StatusSnapshot& now, HealthReport& report) {
  add_session(now, report);
  add_hint(now, report);
  add_place(now, report);
  add_other_station(now, report);
  add_disk(now, report);
}

}  // namespace isobar
