// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "ipc/topics.hpp"

namespace isobar {

/// A change of an entry's level, for the log.
struct LevelChange {
  std::string name;                                ///< of the entry
  ipc::HealthLevel level = ipc::HealthLevel::kOk;  ///< of folded changes the worst
  bool is_fault = false;                           ///< false: well, or not heard yet
  std::string text;                                ///< "silent for 3 s on UDP port 2368"
  double value = 0.0;
};

/// Finds the entries of health reports whose level has changed. An entry that changes again and again is
/// folded: after four lines, one line counts the changes of the first minute, the next those of four
/// minutes, sixteen, an hour. Once it has been quiet for five minutes, its next change is a line again.
class LevelChanges {
 public:
  static constexpr std::int64_t kFirstWindowNs = 60'000'000'000;
  static constexpr std::int64_t kLongestWindowNs = 60 * kFirstWindowNs;
  static constexpr std::int64_t kQuietNs = 5 * kFirstWindowNs;
  /// Lines of an entry before its changes are folded: two faults and their ends.
  static constexpr int kFreeLines = 4;

  /// Call once per report for each of its entries.
  /// @param now_ns any clock that does not descend
  /// @return a change to log. A new entry counts as changed, except that a counter (a '/' in its name) that
  ///         starts at kOk is not logged.
  std::optional<LevelChange> note(const std::string& name, ipc::HealthLevel level, const std::string& message,
                                  std::int64_t now_ns, double value = 0.0);

 private:
  struct Entry {
    ipc::HealthLevel level = ipc::HealthLevel::kOk;
    bool was_ok = false;     // at any time
    bool was_fault = false;  // since it was last ok
    std::int64_t changed_ns = 0;
    int lines = 0;    // since it was last quiet
    int changes = 0;  // since window_start_ns
    int folded = 0;   // of these, without a line
    std::int64_t window_start_ns = 0;
    std::int64_t window_ns = kFirstWindowNs;
    ipc::HealthLevel worst = ipc::HealthLevel::kOk;  // since window_start_ns
  };

  static bool takes_line(Entry& entry, std::int64_t now_ns, ipc::HealthLevel level);
  static bool folds(Entry& entry, std::int64_t now_ns, LevelChange& change);

  std::map<std::string, Entry> entries_;
};

}  // namespace isobar
