// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "daemon/worker_watch.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// The life of a thread that lives on messages: `drain()` whenever some wait, and a last time when the waiter
/// was stopped. It may not throw.
/// @param limit without messages drain() is called so often; zero: never
template <class Drain>
void drain_until_stopped(ipc::Waiter& waiter, Heartbeat& heartbeat, const Drain& drain,
                         std::chrono::nanoseconds limit = {}) noexcept {
  const bool limited = limit.count() > 0;
  while ((limited ? waiter.wait_for(limit) : waiter.wait()) != ipc::Waiter::Event::kStopped) {
    heartbeat.beat();
    drain();
  }
  drain();
}

}  // namespace isobar
