// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker_group.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "daemon/health_entry.hpp"

namespace isobar {

std::vector<std::string> WorkerGroup::refused_settings() const {
  std::vector<ThreadSettings> settings;
  for (const Member& member : members_) settings.push_back(member.worker->settings());
  return try_settings(settings);
}

void WorkerGroup::start() {
  for (const Member& member : members_) member.worker->start();
}

void WorkerGroup::stop() noexcept {
  std::for_each(members_.rbegin(), members_.rend(), [](const Member& member) { member.worker->stop(); });
}

bool WorkerGroup::all_alive(std::int64_t now_ns) {
  hung_.clear();
  hung_count_ = 0;
  for (const auto& [worker, watch] : members_) {
    if (watch == Watch::kNo) continue;
    const std::int64_t silent_ns = now_ns - worker->heartbeat().last_ns();
    if (silent_ns > kSilenceNs) {
      hung_ += fmt::format("{}{} for {:.0f} s", hung_.empty() ? "" : ", ", worker->settings().name,
                           static_cast<double>(silent_ns) * 1e-9);
      ++hung_count_;
    }
    worker->wake();
  }
  return hung_count_ == 0;
}

void WorkerGroup::fill(ipc::HealthReport& report) const {
  if (hung_count_ == 0) {
    add_entry(report, "threads", ipc::HealthLevel::kOk, "all threads run", 0.0);
  } else {
    add_entry(report, "threads", ipc::HealthLevel::kError,
              "hung: " + hung_ + "; the service manager will restart isobard",
              static_cast<double>(hung_count_));
  }
}

}  // namespace isobar
