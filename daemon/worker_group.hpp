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
  /// A thread without a beat for longer hangs. 20 times the slowest map update; with the 10 s of WatchdogSec=
  /// a disk that stalls for a moment does not restart the estimator.
  static constexpr std::int64_t kSilenceNs = 5'000'000'000;

  WorkerGroup() = default;
  ~WorkerGroup() { stop(); }
  WorkerGroup(const WorkerGroup&) = delete;
  WorkerGroup& operator=(const WorkerGroup&) = delete;

  void add(Worker& worker, Watch watch = Watch::kYes) { members_.push_back({&worker, watch}); }

  /// Tries the scheduling of every worker on a thread that ends at once.
  /// @return one sentence for each refusal by the system
  [[nodiscard]] std::vector<std::string> refused_settings() const;

  /// Consumers first: nothing is produced without a consumer.
  /// @throws std::system_error when a thread is refused
  void start();
  /// Producers first: everything under way still reaches its consumer. Joins.
  void stop() noexcept;

  /// Checks all heartbeats and wakes all workers, so that an idle one beats before the next check. (A time
  /// limit on its wait would not do: iceoryx waits on the wall clock, and a clock that is set back would make
  /// idle look hung.) Call at least once a second.
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
