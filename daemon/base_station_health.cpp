// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_station_health.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

namespace isobar {
namespace {

using ipc::HealthLevel;

/// Time after its last sample for which a second base station is reported: ten samples of a base station that
/// sends once a second.
constexpr std::int64_t kRivalMemoryNs = 10'000'000'000;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Entry of one counter.
struct CounterEntry {
  const char* name;
  const char* sentence;
  std::uint64_t now;
  std::uint64_t before;
};

}  // namespace

void add_base_station_state(const std::string& name, const BaseStationStatus& status, std::int64_t now_ns,
                            const std::string& where, const AddEntry& add, bool expected) {
  if (!status.heard() && !expected) {
    add(name, HealthLevel::kOk, "none: never heard on " + where, 0.0);
  } else if (!status.heard()) {
    add(name, HealthLevel::kStale, "nothing received yet on " + where, 0.0);
  } else if (status.left) {
    add(name, HealthLevel::kError, "has ended; it sent on " + where, 0.0);
  } else if (status.lost(now_ns)) {
    add(name, HealthLevel::kError,
        fmt::format("silent for {:.1f} s on {}", seconds(now_ns - status.last_ns), where), 0.0);
  } else if (status.rival_ns != 0 && now_ns - status.rival_ns < kRivalMemoryNs) {
    add(name, HealthLevel::kWarning, "a second base station sends on " + where + "; the first one is used",
        0.0);
  } else {
    const double rate_hz = status.interval_ns > 0 ? 1.0 / seconds(status.interval_ns) : 0.0;
    add(name, HealthLevel::kOk,
        fmt::format("{:.1f} per second, clock offset {:+.1f} s", rate_hz, seconds(status.clock_ahead_ns)),
        rate_hz);
  }
}

void add_base_station_counts(const std::string& name, const BaseStationStatus& now,
                             const BaseStationStatus& before, const AddEntry& add) {
  using V = BaseVerdict;
  const auto samples = [&](const char* what, const char* sentence, V verdict) {
    return CounterEntry{what, sentence, now.count(verdict), before.count(verdict)};
  };
  const std::array<CounterEntry, 9> lines{{
      samples("repeated", "samples received before, refused: copies or a replay", V::kRepeated),
      samples("outdated", "samples older than the newest, refused: out of order or replayed", V::kOutdated),
      samples("too_old", "samples with too long a transmission time, refused", V::kTooOld),
      samples("ahead", "samples from the future, refused: its clock was set", V::kAhead),
      samples("other_sender", "samples of another sender with the same name, refused", V::kOtherSender),
      samples("unconfirmed", "first samples after a restart of the base station, not yet used",
              V::kUnconfirmed),
      {"outages", "silences that ended", now.outages, before.outages},
      {"restarts", "restarts of the base station", now.restarts, before.restarts},
      {"clock_steps", "steps of its clock", now.clock_steps, before.clock_steps},
  }};
  for (const CounterEntry& line : lines) {
    if (line.now == 0) continue;
    add(name + "/" + line.name, line.now > line.before ? HealthLevel::kWarning : HealthLevel::kOk,
        line.sentence, static_cast<double>(line.now));
  }
}

}  // namespace isobar
