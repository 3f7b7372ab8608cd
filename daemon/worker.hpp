// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "daemon/realtime.hpp"

namespace isobar {

/// Time of a thread's last round, written by that thread and read by the main thread. Lock-free.
class Heartbeat {
 public:
  Heartbeat();  ///< counts as the first beat, so that the thread has time to start
  void beat() noexcept;
  /// For a caller that has already read the robot clock.
  void beat_at(std::int64_t now_ns) noexcept { last_ns_.store(now_ns, std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> last_ns_;  // robot clock
};

/// One thread: name, scheduling, start, stop, join and heartbeat. A thread class consists of a noexcept loop,
/// the state of that loop and, as its last member, a Worker: its destructor joins the thread before any state
/// of the loop is destroyed. Owner's thread only, except heartbeat() and wake().
class Worker {
 public:
  /// @param source wait primitive of the loop; must outlive the Worker. `source.stop()` ends the current and
  ///        all later waits. `source.wake()`, if it exists, ends one wait, so that an idle loop beats;
  ///        without it the loop's waits must have a timeout well below WorkerGroup::kSilenceNs.
  /// @param loop must not throw; beats in every round; returns once the source is stopped
  template <class WaitSource>
  Worker(ThreadSettings settings, WaitSource& source, std::function<void()> loop)
      : settings_(std::move(settings)), loop_(std::move(loop)), stop_source_([&source] { source.stop(); }) {
    if constexpr (requires { source.wake(); }) wake_source_ = [&source] { source.wake(); };
  }
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Starts the thread. Call once: a stopped source stays stopped, so a stage is restarted by constructing it
  /// anew.
  /// @throws std::system_error when the kernel refuses a thread
  void start();
  void stop() noexcept;  ///< stops the source and joins; does nothing the second time
  /// Ends one wait of the loop; does nothing if the source has no wake(). Any thread.
  void wake() const {
    if (wake_source_) wake_source_();
  }

  [[nodiscard]] const ThreadSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] Heartbeat& heartbeat() noexcept { return heartbeat_; }
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void run() noexcept;

  ThreadSettings settings_;
  std::function<void()> loop_;
  std::function<void()> stop_source_;
  std::function<void()> wake_source_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar
