// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker.hpp"

#include "drivers/clock/robot_clock.hpp"

namespace isobar {

Heartbeat::Heartbeat() : last_ns_(RobotClock::now_ns()) {}

void Heartbeat::beat() noexcept { beat_at(RobotClock::now_ns()); }

void Worker::start() {
  thread_ = std::thread([this] { run(); });
}

void Worker::stop() noexcept {
  stop_source_();
  if (thread_.joinable()) thread_.join();
}

// A refused setting was already found and reported by WorkerGroup::refused_settings().
void Worker::run() noexcept {
  (void)apply_to_this_thread(settings_);
  loop_();
}

}  // namespace isobar
