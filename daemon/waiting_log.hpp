// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace isobar {

/// Log lines about what the inputs wait for: once when the wait begins, then every minute, and its end. One
/// thread.
class WaitingLog {
 public:
  static constexpr std::int64_t kRepeatNs = 60'000'000'000;

  /// @param waiting_for what is waited for now, a sentence each; empty texts are skipped
  /// @param now_ns robot clock
  /// @return the lines that are due
  std::vector<std::string> due(const std::vector<std::string>& waiting_for, std::int64_t now_ns) {
    std::vector<std::string> lines;
    std::map<std::string, std::int64_t> still;
    for (const std::string& what : waiting_for) {
      if (what.empty()) continue;
      const auto known = said_ns_.find(what);
      const bool is_due = known == said_ns_.end() || now_ns - known->second >= kRepeatNs;
      if (is_due) lines.push_back(what + "; tried again every second");
      still[what] = is_due ? now_ns : known->second;
    }
    for (const auto& [what, said_ns] : said_ns_) {
      if (!still.contains(what)) lines.push_back("no longer: " + what);
    }
    said_ns_ = std::move(still);
    return lines;
  }

 private:
  std::map<std::string, std::int64_t> said_ns_;  // what is waited for, and when it was last said
};

}  // namespace isobar
