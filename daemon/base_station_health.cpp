// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_station_health.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

namespace isobar {
namespace {

using ipc::HealthLevel;

/// A second base station that was heard within this time is still one [ns].
constexpr std::int64_t kRivalMemoryNs = 10'000'000'000;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// A line of the counts.
struct Line {
  const char* name;
  const char* sentence;
  std::uint64_t now;
  std::uint64_t before;
};

}  // namespace

void add_base_station_state(const std::string& name, const BaseStationStatus& status, std::int64_t now_ns,
                            const std::string& where, const AddEntry& add) {
  if (!status.heard()) {
    add(name, HealthLevel::kStale, "nothing received yet on " + where, 0.0);
  } else if (status.left) {
    add(name, HealthLevel::kError, "has ended; was on " + where, 0.0);
  } else if (status.lost(now_ns)) {
    add(name, HealthLevel::kError,
        fmt::format("silent for {:.1f} s on {}", seconds(now_ns - status.last_ns), where), 0.0);
  } else if (status.rival_ns != 0 && now_ns - status.rival_ns < kRivalMemoryNs) {
    add(name, HealthLevel::kWarning,
        "another base station sends on " + where + "; the first one heard is used", 0.0);
  } else {
    const double rate_hz = status.interval_ns > 0 ? 1.0 / seconds(status.interval_ns) : 0.0;
    add(name, HealthLevel::kOk,
        fmt::format("{:.1f} per second, its clock differs by {:+.1f} s", rate_hz,
                    seconds(status.clock_ahead_ns)),
        rate_hz);
  }
}

void add_base_station_counts(const std::string& name, const BaseStationStatus& now,
                             const BaseStationStatus& before, const AddEntry& add) {
  using V = BaseVerdict;
  const auto samples = [&](const char* what, const char* sentence, V verdict) {
    return Line{what, sentence, now.count(verdict), before.count(verdict)};
  };
  const std::array<Line, 9> lines{{
      samples("repeated", "samples that came before, refused: copies or a replay", V::kRepeated),
      samples("outdated", "samples older than the newest, refused: overtaken or replayed", V::kOutdated),
      samples("too_old", "samples that were on their way for too long, refused", V::kTooOld),
      samples("ahead", "samples from the future, refused: its clock was set", V::kAhead),
      samples("other_sender", "samples of another base station of the same name, refused", V::kOtherSender),
      samples("unconfirmed", "first samples of a base that was started again, not yet used", V::kUnconfirmed),
      {"outages", "times that it was silent and came back", now.outages, before.outages},
      {"restarts", "times that it was started again", now.restarts, before.restarts},
      {"clock_steps", "times that its clock was set", now.clock_steps, before.clock_steps},
  }};
  for (const Line& line : lines) {
    if (line.now == 0) continue;
    add(name + "/" + line.name, line.now > line.before ? HealthLevel::kWarning : HealthLevel::kOk,
        line.sentence, static_cast<double>(line.now));
  }
}

}  // namespace isobar
