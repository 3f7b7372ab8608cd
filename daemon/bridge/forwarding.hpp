// SPDX-License-Identifier: BSD-3-Clause
// The bridge at work: what comes through shared memory goes out over DDS.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "daemon/bridge/outputs.hpp"
#include "daemon/bridge/receiving.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/seq_lock.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Publishes that isobard does not run. For the time before a Forwarding exists.
void report_absence(Outputs& outputs, dds::DiagnosticsBuilder& builder);

/// Forwards in two threads, so that a cloud of a megabyte never holds up odometry. The process must be
/// attached to isobard; the outputs are this object's alone as long as it lives.
class Forwarding {
 public:
  /// @throws ServiceError shared memory refuses
  Forwarding(Outputs& outputs, const dds::DdsConfig& config);
  ~Forwarding();
  Forwarding(const Forwarding&) = delete;
  Forwarding& operator=(const Forwarding&) = delete;

  /// What came the other way, to be told in the diagnostics. One thread.
  void note_received(const ReceivedCounts& counts) noexcept;
  [[nodiscard]] const RobotClock& clock() const noexcept { return clock_; }
  /// Rounds of the pose thread: it stands still only if that thread hangs.
  [[nodiscard]] std::uint64_t rounds() const noexcept { return rounds_.load(std::memory_order_relaxed); }
  /// Time since the last message of isobard; zero before the first.
  [[nodiscard]] std::chrono::nanoseconds silence() const noexcept;

 private:
  /// Made only if clouds are wanted: isobard makes no map cloud that nobody reads.
  struct CloudsIn {
    CloudsIn();
    ipc::Subscriber<RegisteredScan> scan;
    ipc::Subscriber<ipc::MapCloud> map;
    ipc::Waiter waiter;
  };

  void forward_poses() noexcept;
  void forward_clouds() noexcept;
  void forward_health();
  void add_own_health();
  void add_station_health(const ReceivedCounts& received);
  /// Adds a line to the diagnostics, and logs it if it is news.
  void add(const std::string& name, ipc::HealthLevel level, const std::string& message, double value);
  void note_data() noexcept;

  Outputs& outputs_;
  std::array<std::string, 2> station_topics_;
  ipc::Subscriber<Prior> prior_in_;
  ipc::Subscriber<PoseEstimate> pose_in_;
  ipc::Subscriber<PressureSample> station_in_;  ///< a base station's own pressure
  ipc::Subscriber<ipc::HealthReport> health_in_;
  ipc::Waiter pose_waiter_;
  std::optional<CloudsIn> clouds_in_;
  dds::DiagnosticsBuilder diagnostics_;
  std::atomic<std::uint64_t> rounds_{0};
  std::atomic<std::int64_t> last_data_ns_{0};  ///< steady clock, 0: never
  std::atomic<std::uint64_t> clouds_dropped_{0};
  std::atomic<std::uint64_t> cloud_failures_{0};
  SeqLock<ReceivedCounts> received_;
  ReceivedCounts last_received_;  ///< pose thread
  LevelChanges changes_;          ///< pose thread
  RobotClock clock_;
  std::int64_t last_report_ns_ = 0;  ///< steady clock; pose thread
  std::thread pose_thread_;
  std::thread cloud_thread_;
};

}  // namespace isobar::bridge
