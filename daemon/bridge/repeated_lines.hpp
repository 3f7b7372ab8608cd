// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace isobar::bridge {

/// Thins the lines of a library that repeats itself, or whose lines a stranger can cause: the first line of
/// each kind at once, then one line with the count of all others, after a minute, four, sixteen, and then every
/// hour. Lines that differ in numbers only, such as addresses, are of one kind. Any thread.
class RepeatedLines {
 public:
  static constexpr std::int64_t kPeriodNs = 60'000'000'000;         ///< from the first line to its count
  static constexpr std::int64_t kLongestPeriodNs = 60 * kPeriodNs;  ///< between two counts
  static constexpr std::int64_t kQuietNs = 5 * kPeriodNs;           ///< after which kPeriodNs holds again
  static constexpr std::int64_t kForgetNs = 60 * kPeriodNs;  ///< after which a line is a first one again
  static constexpr std::size_t kMaxKinds = 16;               ///< all further ones count as one kind
  static constexpr std::size_t kMaxLineBytes = 200;          ///< of a line in the log

  /// @param now_ns monotonic clock
  /// @return the line for the log, unprintable bytes replaced by '?'; none where the line is counted only
  std::optional<std::string> note(std::string_view line, std::int64_t now_ns);

  /// The count that is due: "17 more in 60 s: LINE", where all are of one kind.
  std::optional<std::string> due(std::int64_t now_ns);

 private:
  struct Kind {
    std::string line;  ///< the first of it
    std::int64_t last_ns = 0;
    std::uint64_t count = 0;  ///< since the last count was logged
  };
  [[nodiscard]] std::string text_of_counts(std::int64_t now_ns) const;

  std::mutex mutex_;
  std::map<std::string, Kind> kinds_;
  std::uint64_t count_ = 0;    ///< of all kinds
  std::int64_t since_ns_ = 0;  ///< of the first line in count_
  std::int64_t last_ns_ = 0;   ///< of the last line
  std::int64_t period_ns_ = kPeriodNs;
};

}  // namespace isobar::bridge
