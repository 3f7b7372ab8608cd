// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/topics.hpp"

namespace isobar::black_box {

/// Decides from the health reports when a fault saves the black box: a chosen entry that was not an error
/// becomes one. Entries that are errors from the start save nothing: nothing led to them. One thread.
class FaultTrigger {
 public:
  /// Shortest time between two saves for faults [ns]: a fault that comes and goes must not replace all saved
  /// recordings within minutes.
  static constexpr std::int64_t kMinIntervalNs = 300'000'000'000;

  /// @param save_on "any", "none", or names of entries separated by blanks; a name stands also for the entries
  ///        below it: "lidar" for "lidar/model"
  explicit FaultTrigger(std::string_view save_on);

  /// @param now_ns CLOCK_MONOTONIC
  /// @return name of the entry for whose fault the black box is to be saved
  [[nodiscard]] std::optional<std::string> check(const ipc::HealthReport& report, std::int64_t now_ns);

 private:
  [[nodiscard]] bool is_chosen(std::string_view name) const;

  bool any_ = false;
  std::vector<std::string> names_;
  std::map<std::string, ipc::HealthLevel, std::less<>> levels_;
  std::optional<std::int64_t> saved_ns_;
};

}  // namespace isobar::black_box
