// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/worker_watch.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// The life of a thread that lives on messages: `drain()` whenever some wait, and a last time when the waiter
/// was stopped. It may not throw.
template <class Drain>
void drain_until_stopped(ipc::Waiter& waiter, Heartbeat& heartbeat, const Drain& drain) noexcept {
  while (waiter.wait() != ipc::Waiter::Event::kStopped) {
    heartbeat.beat();
    drain();
  }
  drain();
}

}  // namespace isobar
