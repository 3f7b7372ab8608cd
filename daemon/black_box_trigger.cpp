// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/black_box_trigger.hpp"

#include <algorithm>
#include <sstream>

namespace isobar::black_box {

FaultTrigger::FaultTrigger(std::string_view save_on) {
  std::istringstream words{std::string(save_on)};
  for (std::string word; words >> word;) {
    if (word == "any") {
      any_ = true;
    } else if (word != "none") {
      names_.push_back(word);
    }
  }
}

bool FaultTrigger::is_chosen(std::string_view name) const {
  return any_ || std::any_of(names_.begin(), names_.end(), [name](const std::string& chosen) {
           return name == chosen || name.starts_with(chosen + "/");
         });
}

std::optional<std::string> FaultTrigger::check(const ipc::HealthReport& report, std::int64_t now_ns) {
  std::optional<std::string> fault;
  for (std::uint32_t i = 0; i < std::min(report.entry_count, ipc::HealthReport::kMaxEntries); ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    const std::string_view name(entry.name);
    const auto known = levels_.find(name);
    const bool is_error = entry.level == ipc::HealthLevel::kError;
    const bool was_good = known != levels_.end() && (known->second == ipc::HealthLevel::kOk ||
                                                     known->second == ipc::HealthLevel::kWarning);
    const bool is_cause = name != ipc::HealthReport::kSummaryName;  // the summary only repeats another entry
    if (!fault && is_cause && is_error && was_good && is_chosen(name)) fault = name;
    levels_.insert_or_assign(std::string(name), entry.level);
  }
  if (fault && saved_ns_ && now_ns - *saved_ns_ < kMinIntervalNs) return std::nullopt;
  if (fault) saved_ns_ = now_ns;
  return fault;
}

}  // namespace isobar::black_box
