// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::bridge {

/// Thins the lines of a library that repeats itself, or whose lines a stranger can cause: the first line of
/// each kind at once, then once a minute how many more of the kind came. Lines that differ in numbers only,
/// such as addresses, are of one kind. Any thread.
class RepeatedLines {
 public:
  static constexpr std::int64_t kPeriodNs = 60'000'000'000;
  static constexpr std::size_t kMaxKinds = 16;       ///< all further ones count as one kind
  static constexpr std::size_t kMaxLineBytes = 200;  ///< of a line in the log

  /// @param now_ns monotonic clock
  /// @return the line for the log, unprintable bytes replaced by '?'; none where the line is counted only
  std::optional<std::string> note(std::string_view line, std::int64_t now_ns);

  /// The counts that are due: "17 more in 60 s: LINE".
  std::vector<std::string> due(std::int64_t now_ns);

 private:
  struct Kind {
    std::string line;  ///< the first of it
    std::int64_t since_ns = 0;
    std::uint64_t count = 0;
  };
  std::mutex mutex_;
  std::map<std::string, Kind> kinds_;
};

}  // namespace isobar::bridge
