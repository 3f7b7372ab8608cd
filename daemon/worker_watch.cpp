// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker_watch.hpp"

#include <spdlog/fmt/fmt.h>

#include "drivers/datagram/udp.hpp"

namespace isobar {

Heartbeat::Heartbeat() : last_ns_(RobotClock::now_ns()) {}

void Heartbeat::beat() noexcept { beat_at(RobotClock::now_ns()); }

bool WorkerWatch::all_alive(std::int64_t now_ns) {
  hung_.clear();
  hung_count_ = 0;
  for (const Worker& worker : workers_) {
    const std::int64_t silent_ns = now_ns - worker.heartbeat->last_ns();
    if (silent_ns > kSilenceNs) {
      hung_ += fmt::format("{}{} for {:.0f} s", hung_.empty() ? "" : ", ", worker.name,
                           static_cast<double>(silent_ns) * 1e-9);
      ++hung_count_;
    }
    if (worker.knock) worker.knock();
  }
  return hung_count_ == 0;
}

void WorkerWatch::fill(ipc::HealthReport& report) const {
  if (hung_count_ == 0) {
    report.add("threads", ipc::HealthLevel::kOk, "all answer", 0.0);
  } else {
    report.add("threads", ipc::HealthLevel::kError, "no answer of " + hung_ + "; a service manager restarts",
               static_cast<double>(hung_count_));
  }
}

}  // namespace isobar
