// SPDX-License-Identifier: BSD-3-Clause
// What a health report says as a whole, and the hysteresis of its limits. For isobard and isobar-dds.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "ipc/topics.hpp"

namespace isobar {

/// Adds the summary's entry, to be filled by fill_summary(). Call it on an empty report: the summary is the
/// first entry and is never dropped.
void reserve_summary(ipc::HealthReport& report);

/// Fills the first entry: the worst level of all others, with name and message of the first of that level.
/// The value is the number of entries that are not ok.
void fill_summary(ipc::HealthReport& report);

/// Hysteresis: a counter or limit (a '/' in its name) stays a warning for ten seconds after its last warning,
/// so that a loss every other second is one warning and not a change every second.
class LevelHold {
 public:
  static constexpr std::int64_t kHoldNs = 10'000'000'000;

  /// Raises the entries that are still held.
  /// @param now_ns any clock that does not descend
  void apply(std::int64_t now_ns, ipc::HealthReport& report);

 private:
  struct Warning {
    std::int64_t last_ns = 0;
    std::string message;
  };
  std::map<std::string, Warning> warnings_;
};

}  // namespace isobar
