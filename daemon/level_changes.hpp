// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "ipc/topics.hpp"

namespace isobar {

/// Finds the entries of health reports whose level has changed, for the log.
class LevelChanges {
 public:
  /// @return the log line, "imu: ok: 200.0 per second", when the level of this entry has changed. A new entry
  ///        counts as changed, except that a counter (a '/' in its name) that starts at kOk is not logged.
  std::optional<std::string> note(const std::string& name, ipc::HealthLevel level,
                                  const std::string& message) {
    constexpr const char* kWords[] = {"ok", "warning", "error",
                                      "waiting"};  // NOLINT(modernize-avoid-c-arrays)
    const auto [known, is_new] = levels_.try_emplace(name, level);
    const bool changed = is_new ? level != ipc::HealthLevel::kOk || name.find('/') == std::string::npos
                                : known->second != level;
    known->second = level;
    if (!changed) return std::nullopt;
    return name + ": " + kWords[static_cast<std::size_t>(level)] + ": " + message;
  }

 private:
  std::map<std::string, ipc::HealthLevel> levels_;
};

}  // namespace isobar
