// SPDX-License-Identifier: BSD-3-Clause
// The bridge at work: what comes through shared memory goes out over DDS.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>

#include "daemon/bridge/receiving.hpp"
#include "ipc/dds/outputs.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Publishes that isobard does not run. For the time before a Forwarding exists.
void report_absence(dds::PoseOutputs& outputs, dds::DiagnosticsBuilder& builder);

/// Forwards in two threads, so that a cloud of a megabyte never holds up odometry. The process must be
/// attached to isobard; the outputs are this object's alone as long as it lives.
class Forwarding {
 public:
  /// @throws ServiceError shared memory refuses
  Forwarding(dds::PoseOutputs& poses, dds::CloudOutputs& clouds, bool with_clouds);
  ~Forwarding();
  Forwarding(const Forwarding&) = delete;
  Forwarding& operator=(const Forwarding&) = delete;

  /// What came the other way, to be told in the diagnostics.
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
  void note_data() noexcept;

  dds::PoseOutputs& poses_;
  dds::CloudOutputs& clouds_;
  ipc::Subscriber<Prior> prior_in_;
  ipc::Subscriber<PoseEstimate> pose_in_;
  ipc::Subscriber<PressureSample> barometer_in_;
  ipc::Subscriber<ipc::HealthReport> health_in_;
  ipc::Waiter pose_waiter_;
  std::optional<CloudsIn> clouds_in_;
  dds::DiagnosticsBuilder diagnostics_;
  std::atomic<std::uint64_t> rounds_{0};
  std::atomic<std::int64_t> last_data_ns_{0};  ///< steady clock, 0: never
  std::atomic<std::uint64_t> clouds_dropped_{0};
  std::atomic<std::uint64_t> cloud_failures_{0};
  std::atomic<std::uint64_t> received_refused_{0};
  std::atomic<std::uint64_t> received_early_{0};
  RobotClock clock_;
  std::int64_t last_report_ns_ = 0;  ///< steady clock; pose thread
  std::thread pose_thread_;
  std::thread cloud_thread_;
};

}  // namespace isobar::bridge
