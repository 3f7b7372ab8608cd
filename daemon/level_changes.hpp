// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "ipc/topics.hpp"

namespace isobar {

/// Which entries of a health report are news for the log: those whose level has changed.
class LevelChanges {
 public:
  /// Returns the line for the log, "imu: ok: 200.0 per second", if this entry is news. An entry that is seen
  /// for the first time and is well is news only if it is a sensor's own, without a '/' in its name.
  std::optional<std::string> note(const std::string& name, ipc::HealthLevel level,
                                  const std::string& message) {
    constexpr const char* kWords[] = {"ok", "warning", "error",
                                      "waiting"};  // NOLINT(modernize-avoid-c-arrays)
    const auto [known, is_new] = levels_.try_emplace(name, level);
    const bool is_news = is_new ? level != ipc::HealthLevel::kOk || name.find('/') == std::string::npos
                                : known->second != level;
    known->second = level;
    if (!is_news) return std::nullopt;
    return name + ": " + kWords[static_cast<std::size_t>(level)] + ": " + message;
  }

 private:
  std::map<std::string, ipc::HealthLevel> levels_;
};

}  // namespace isobar
