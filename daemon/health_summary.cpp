// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_summary.hpp"

#include <algorithm>
#include <string_view>

namespace isobar {

using ipc::HealthEntry;
using ipc::HealthLevel;
using ipc::HealthReport;

void reserve_summary(HealthReport& report) {
  static_cast<void>(report.add(HealthReport::kSummaryName, HealthLevel::kOk, "", 0.0));
}

void fill_summary(HealthReport& report) {
  if (report.entry_count == 0) return;
  const HealthEntry* worst = nullptr;
  std::uint32_t others = 0;
  for (std::uint32_t i = 1; i < report.entry_count; ++i) {
    const HealthEntry& entry = report.entries[i];
    if (entry.level == HealthLevel::kOk) continue;
    ++others;
    if (worst == nullptr || ipc::severity(entry.level) > ipc::severity(worst->level)) worst = &entry;
  }
  std::string text = "all is well";
  if (worst != nullptr) {
    text = std::string(worst->name) + ": " + worst->message;
    const std::string more = others > 1 ? " (and " + std::to_string(others - 1) + " more)" : "";
    text.resize(std::min(text.size(), HealthEntry::kMessageBytes - 1 - more.size()));
    text += more;
  }
  HealthEntry& summary = report.entries[0];
  ipc::copy_text(text, summary.message, HealthEntry::kMessageBytes);
  summary.level = worst != nullptr ? worst->level : HealthLevel::kOk;
  summary.value = others;
}

void LevelHold::apply(std::int64_t now_ns, HealthReport& report) {
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    HealthEntry& entry = report.entries[i];
    if (std::string_view(entry.name).find('/') == std::string_view::npos) continue;
    if (entry.level == HealthLevel::kWarning) warnings_[entry.name] = {now_ns, entry.message};
    if (entry.level != HealthLevel::kOk) continue;
    const auto held = warnings_.find(entry.name);
    if (held == warnings_.end() || now_ns - held->second.last_ns >= kHoldNs) continue;
    const auto ago_s = std::to_string((now_ns - held->second.last_ns) / 1'000'000'000);
    entry.level = HealthLevel::kWarning;
    ipc::copy_text(held->second.message + " (last " + ago_s + " s ago)", entry.message,
                   HealthEntry::kMessageBytes);
  }
}

}  // namespace isobar
