// SPDX-License-Identifier: BSD-3-Clause
// Receivers, each in its own thread with ordinary scheduling, like a node of the robot.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/participant.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/benchmark/live/arrivals.hpp"

namespace isobar::benchmark {

/// The topic `pose` over DDS.
class PoseListener {
 public:
  PoseListener();
  ~PoseListener();
  PoseListener(const PoseListener&) = delete;
  PoseListener& operator=(const PoseListener&) = delete;
  [[nodiscard]] std::vector<Event> poses() const;

 private:
  void listen();

  dds::Participant participant_;
  dds::Reader<dds::PoseMessage> reader_;
  dds::Entity waitset_;
  mutable std::mutex mutex_;
  std::vector<Event> poses_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// Messages received through shared memory.
struct MemoryEvents {
  std::vector<Event> scans, priors, poses;
  std::vector<Event> wake_ups;           ///< of registered scans; stamp_ns: time of the hand-over
  std::map<std::string, double> health;  ///< value of each entry of the newest report
};

struct Queues {
  ipc::Subscriber<Scan> scans{ipc::topics::kLidarScan};
  ipc::Subscriber<Prior> priors{ipc::topics::kPrior};
  ipc::Subscriber<PoseEstimate> poses{ipc::topics::kPose};
  ipc::Subscriber<RegisteredScan> registered{ipc::topics::kRegisteredScan};
};

/// Subscriber to the queues in shared memory, from outside isobard. At most one per process.
class MemoryListener {
 public:
  /// @param queues true: subscribe to every sample, scan and pose, each of which isobard then signals;
  ///               false: to the health report only
  explicit MemoryListener(bool queues);
  ~MemoryListener();
  MemoryListener(const MemoryListener&) = delete;
  MemoryListener& operator=(const MemoryListener&) = delete;
  [[nodiscard]] MemoryEvents events() const;

 private:
  void listen();
  void drain();

  ipc::Attachment attachment_;
  std::optional<Queues> queues_;
  ipc::Subscriber<ipc::HealthReport> health_;
  std::optional<ipc::Waiter> waiter_;
  mutable std::mutex mutex_;
  MemoryEvents events_;
  std::thread thread_;
};

}  // namespace isobar::benchmark
