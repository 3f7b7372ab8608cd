// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Timeout of a loop that only messages and wake() wake.
struct NoTimeout {
  std::chrono::nanoseconds operator()() const noexcept { return {}; }
};

/// Loop of a thread that consumes messages: one beat and one `drain()` per wake-up, and a last `drain()`
/// after the waiter was stopped.
/// @param drain handles all waiting messages; must not throw
/// @param timeout returns the longest wait before the next round; zero: unlimited
template <class Drain, class Timeout = NoTimeout>
void drain_until_stopped(ipc::Waiter& waiter, Heartbeat& heartbeat, const Drain& drain,
                         const Timeout& timeout = {}) noexcept {
  const auto wait = [&] {
    const std::chrono::nanoseconds limit = timeout();
    return limit.count() > 0 ? waiter.wait_for(limit) : waiter.wait();
  };
  while (wait() != ipc::Waiter::Event::kStopped) {
    heartbeat.beat();
    drain();
  }
  drain();
}

}  // namespace isobar
