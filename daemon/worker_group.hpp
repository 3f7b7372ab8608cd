// SPDX-License-Identifier: BSD-3-Clause
// The threads of one program: started and stopped in order, and watched.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/worker.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Whether a hung thread ends the program: the watchdog of the
/// service manager is fed only while all watched threads beat.
enum class Watch : std::uint8_t { kYes, kNo };

/// Workers in start order, consumers first. Does not own them: declare the group after them. Main thread.
class WorkerGroup {
 public:
  /// Time without a beat after which a thread counts as hung: 20 times the slowest map update. Together with
  /// WatchdogSec= of 10 s, a disk that stalls for a moment does not restart the estimator.
  static constexpr std::int64_t kSilenceNs = 5'000'000'000;

  WorkerGroup() = default;
  ~WorkerGroup() { stop(); }
  WorkerGroup(const WorkerGroup&) = delete;
  WorkerGroup& operator=(const WorkerGroup&) = delete;

  void add(Worker& worker, Watch watch = Watch::kYes) { members_.push_back({&worker, watch}); }

  /// Tries the scheduling of every worker on a thread that ends at once.
  /// @return one sentence for each refusal by the system
  [[nodiscard]] std::vector<std::string> refused_settings() const;

  /// Starts the threads in the order of add(), consumers first: no message is produced without a consumer.
  /// @throws std::system_error when a thread is refused
  void start();
  /// Stops and joins the threads in reverse order, producers first: messages in the queues still reach their
  /// consumers.
  void stop() noexcept;

  /// Checks the heartbeats of all watched workers, then wakes them, so that an idle one beats before the next
  /// check. A timeout of the wait would not suffice: iceoryx's timed wait runs on the wall clock, and after
  /// that clock is set back an idle thread would look hung. Call at least once a second.
  /// @param now_ns robot clock
  /// @return true when none hangs
  [[nodiscard]] bool all_alive(std::int64_t now_ns);
  /// Adds the result of the last check, as the entry "threads".
  void fill(ipc::HealthReport& report) const;

 private:
  struct Member {
    Worker* worker;
    Watch watch;
  };
  std::vector<Member> members_;
  std::string hung_;  // in the last check: "map for 6 s"
  std::size_t hung_count_ = 0;
};

}  // namespace isobar
