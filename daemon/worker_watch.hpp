// SPDX-License-Identifier: BSD-3-Clause
// Does every thread still go round? The service manager is told only while they all do.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ipc/topics.hpp"

namespace isobar {

/// A worker's sign of life: left in every round of its loop, read by the main thread.
class Heartbeat {
 public:
  Heartbeat();  ///< the first one, so that a worker has time to start
  /// The worker only. No lock, no system call. beat_at(): where the time is known already.
  void beat() noexcept;
  void beat_at(std::int64_t now_ns) noexcept { last_ns_.store(now_ns, std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> last_ns_;  // robot clock
};

/// Knows the workers and who of them is silent. A worker without work has to be woken to show that it lives:
/// the watch knocks. (A wait with a time limit would not do: iceoryx's follows the wall clock, and a clock
/// that is set back would make the idle look dead.) One thread.
class WorkerWatch {
 public:
  /// Silent for longer, a worker hangs. Twenty times what the slowest update of a map took, and with the ten
  /// seconds of systemd's own patience no disk that stalls for a moment restarts a robot's estimator.
  static constexpr std::int64_t kSilenceNs = 5'000'000'000;

  /// A worker, which must outlive the watch. It has a heartbeat() and, where it sleeps without limit, a
  /// knock().
  template <class Worker>
  void add(std::string name, Worker& worker) {
    std::function<void()> knock;
    if constexpr (requires { worker.knock(); }) knock = [&worker] { worker.knock(); };
    workers_.push_back({std::move(name), &worker.heartbeat(), std::move(knock)});
  }

  /// Looks at all and knocks at all; at least once a second. True while every worker is alive.
  [[nodiscard]] bool all_alive(std::int64_t now_ns);
  /// The result of the last look, as an entry of its own, "threads".
  void fill(ipc::HealthReport& report) const;

 private:
  struct Worker {
    std::string name;
    const Heartbeat* heartbeat;
    std::function<void()> knock;
  };
  std::vector<Worker> workers_;
  std::string hung_;  // of the last look: "map for 6 s", empty: none
  std::size_t hung_count_ = 0;
};

}  // namespace isobar
