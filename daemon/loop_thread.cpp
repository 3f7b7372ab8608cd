// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/loop_thread.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "daemon/message_loop.hpp"

namespace isobar {

LoopThread::LoopThread(const StageSettings& settings, std::unique_ptr<LoopFiles> files, MapThread& map,
                       ThreadSettings scheduling)
    : stage_(settings, std::move(files)),
      map_(map),
      scans_(ipc::topics::kRegisteredScan),
      priors_(ipc::topics::kPrior),
      waiter_({&scans_.raw()}),
      worker_(std::move(scheduling), waiter_, [this] { loop(); }) {}

void LoopThread::loop() noexcept {
  drain_until_stopped(waiter_, worker_.heartbeat(), [this] { drain(); });
}

void LoopThread::drain() noexcept {
  while (const auto scan = scans_.take()) {
    // The prior of the scan's end, not the newest: this thread may be late by seconds.
    while (stage_.prior_ns() < scan->pose.stamp_ns) {
      const auto prior = priors_.take();
      if (!prior) break;
      stage_.add_prior(*prior);
    }
    if (auto moved = stage_.add_scan(*scan)) map_.offer(std::make_unique<MovedMap>(std::move(*moved)));
  }
  log_problem();
}

void LoopThread::log_problem() {
  std::string problem = stage_.problem();
  if (problem == logged_) return;
  logged_ = std::move(problem);
  spdlog::warn("loops: {}; poses and map go on", logged_);
}

}  // namespace isobar
