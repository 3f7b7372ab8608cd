// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "daemon/latency_histogram.hpp"

namespace isobar {

/// Punctuality of a stage.
struct DeadlineStatus {
  std::uint64_t outputs = 0;
  std::uint64_t misses = 0;   ///< outputs later than the limit
  std::int64_t worst_ns = 0;  ///< longest time from input to output
  std::int64_t limit_ns = 0;
  std::int64_t last_ns = 0;  ///< time of the newest output, robot clock; 0: none yet
  LatencyHistogram times;    ///< from input to output
};

/// Counts the outputs of a stage that miss its deadline. One thread.
class Deadline {
 public:
  /// @param limit_ms allowed time from input to output, > 0
  explicit Deadline(double limit_ms) { status_.limit_ns = static_cast<std::int64_t>(limit_ms * 1e6); }

  /// Changes the limit; what was counted stays.
  void set_limit(double limit_ms) noexcept { status_.limit_ns = static_cast<std::int64_t>(limit_ms * 1e6); }

  /// Records an output.
  /// @param complete_ns when its input was complete, robot clock
  /// @param now_ns when it was published, robot clock
  void note(std::int64_t complete_ns, std::int64_t now_ns) noexcept {
    const std::int64_t took_ns = now_ns - complete_ns;
    ++status_.outputs;
    status_.misses += took_ns > status_.limit_ns ? 1U : 0U;
    status_.worst_ns = std::max(status_.worst_ns, took_ns);
    status_.last_ns = now_ns;
    status_.times.note(took_ns);
  }
  [[nodiscard]] const DeadlineStatus& status() const noexcept { return status_; }

 private:
  DeadlineStatus status_;
};

}  // namespace isobar
