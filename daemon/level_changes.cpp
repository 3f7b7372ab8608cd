// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/level_changes.hpp"

#include <algorithm>

namespace isobar {
namespace {

using ipc::HealthLevel;

std::string duration_text(std::int64_t ns) {
  const std::int64_t minutes = (ns + LevelChanges::kFirstWindowNs / 2) / LevelChanges::kFirstWindowNs;
  return minutes <= 1 ? "minute" : minutes == 60 ? "hour" : std::to_string(minutes) + " minutes";
}

/// Data that never came is awaited; data that no longer comes is a fault.
bool is_fault(HealthLevel level, bool was_ok) {
  return level == HealthLevel::kWarning || level == HealthLevel::kError ||
         (level == HealthLevel::kStale && was_ok);
}

}  // namespace

std::optional<LevelChange> LevelChanges::note(const std::string& name, HealthLevel level,
                                              const std::string& message, std::int64_t now_ns, double value) {
  // That a count is stale says its sensor's or stage's own entry.
  if (level == HealthLevel::kStale && name.find('/') != std::string::npos && !name.starts_with("bridge/")) {
    return std::nullopt;
  }
  const auto [place, is_new] = entries_.try_emplace(name);
  Entry& entry = place->second;
  const bool is_counter = name.find('/') != std::string::npos;
  const bool changed = is_new ? level != HealthLevel::kOk || !is_counter : entry.level != level;
  const bool recovered = level == HealthLevel::kOk && entry.was_fault;
  LevelChange change{.name = name,
                     .level = level,
                     .is_fault = is_fault(level, entry.was_ok),
                     .text = recovered ? (message.empty() ? "recovered" : "recovered: " + message) : message,
                     .value = value};
  entry.level = level;
  entry.was_ok = entry.was_ok || level == HealthLevel::kOk;
  entry.was_fault = change.is_fault || (entry.was_fault && level != HealthLevel::kOk);
  // Sensors that are awaited and come, at the start, are no part of any flapping.
  if (changed && !change.is_fault && !recovered) return change;
  const bool has_line = changed && takes_line(entry, now_ns, level);
  if (has_line) return change;
  change.text = message;
  if (folds(entry, now_ns, change)) return change;
  return std::nullopt;
}

/// Counts a change; true if it has a line of its own.
bool LevelChanges::takes_line(Entry& entry, std::int64_t now_ns, HealthLevel level) {
  if (entry.changes == 0 && entry.lines == 0) entry.window_start_ns = now_ns;
  ++entry.changes;
  entry.changed_ns = now_ns;
  entry.worst = ipc::severity(level) > ipc::severity(entry.worst) ? level : entry.worst;
  if (entry.lines < kFreeLines) {
    ++entry.lines;
    return true;
  }
  ++entry.folded;
  return false;
}

/// Ends a window that is over. True if `change` is now the line about its folded changes.
bool LevelChanges::folds(Entry& entry, std::int64_t now_ns, LevelChange& change) {
  const bool quiet = now_ns - entry.changed_ns >= kQuietNs;
  if (entry.lines == 0 || (!quiet && now_ns - entry.window_start_ns < entry.window_ns)) return false;
  const bool has_line = entry.folded > 0;
  if (has_line) {
    change.text = "changed " + std::to_string(entry.changes) + " times in the last " +
                  duration_text(now_ns - entry.window_start_ns) +
                  (change.text.empty() ? "" : ", now: " + change.text);
    change.level = entry.worst;
    change.is_fault = true;
    entry.window_ns = std::min(4 * entry.window_ns, kLongestWindowNs);
  }
  if (has_line || quiet) {
    entry.window_start_ns = now_ns;
    entry.changes = entry.folded = 0;
    entry.worst = HealthLevel::kOk;
  }
  if (quiet) {
    entry.lines = 0;
    entry.window_ns = kFirstWindowNs;
  }
  return has_line;
}

}  // namespace isobar
