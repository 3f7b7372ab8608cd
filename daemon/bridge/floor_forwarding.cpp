// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/floor_forwarding.hpp"

#include <spdlog/spdlog.h>

#include "core/errors.hpp"

namespace isobar::bridge {

FloorForwarding::FloorForwarding(dds::FloorOutputs& outputs, const std::atomic<std::int64_t>& stamp_shift_ns)
    : outputs_(outputs),
      stamp_shift_ns_(stamp_shift_ns),
      waiter_({&grids_.raw(), &floors_.raw()}),
      thread_([this] { loop(); }) {}

FloorForwarding::~FloorForwarding() {
  waiter_.stop();
  thread_.join();
}

void FloorForwarding::loop() noexcept {
  while (waiter_.wait() != ipc::Waiter::Event::kStopped) {
    const std::lock_guard lock(mutex_);
    try {
      forward();
    } catch (const Error& error) {
      // A writer cannot be made. The next message, or the next open(), tries it again.
      if (fault_ != error.what()) spdlog::error("{}", error.what());
      fault_ = error.what();
    }
    draft_.lost = grids_.dropped() + floors_.dropped();
    draft_.rejected = grids_.rejected() + floors_.rejected();
    draft_.refused = outputs_.refused();
    draft_.unsent = outputs_.failures();
    state_.put(draft_);
    writers_.store(outputs_.writers().size(), std::memory_order_relaxed);
  }
}

void FloorForwarding::forward() {
  while (const auto floor = floors_.take()) {
    draft_.heard = true;
    draft_.floor = *floor;
    outputs_.on_floor(*floor);
  }
  // One at a time, so that a pause() waits for one piece only.
  if (const auto piece = grids_.take()) {
    outputs_.on_grid(*piece, stamp_shift_ns_.load(std::memory_order_relaxed));
  }
}

}  // namespace isobar::bridge
