// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/loop_thread.hpp"

#include <utility>

#include "daemon/message_loop.hpp"

namespace isobar {

LoopThread::LoopThread(const StageSettings& settings, ThreadSettings scheduling)
    : stage_(settings),
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
    stage_.add_scan(*scan);
  }
}

}  // namespace isobar
