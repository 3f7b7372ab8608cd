// SPDX-License-Identifier: BSD-3-Clause
// From shared memory to DDS.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/time/system_clock_watch.hpp"
#include "daemon/bridge/floor_forwarding.hpp"
#include "daemon/bridge/network.hpp"
#include "daemon/bridge/outputs.hpp"
#include "daemon/bridge/receiving.hpp"
#include "daemon/bridge/station_keys.hpp"
#include "daemon/health_summary.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/seq_lock.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Publishes a diagnostics error, "isobard is not running". Only while no Forwarding exists.
void report_absence(Outputs& outputs, dds::DiagnosticsBuilder& builder);

/// Forwards poses, clouds and floors, each in a thread, so that a cloud of 1 MiB never delays odometry. Requires an
/// Attachment to isobard and, except during a pause(), exclusive use of the outputs during its lifetime.
class Forwarding {
 public:
  /// @throws ServiceError when shared memory cannot be used
  Forwarding(Outputs& outputs, const dds::DdsConfig& config);
  ~Forwarding();
  Forwarding(const Forwarding&) = delete;
  Forwarding& operator=(const Forwarding&) = delete;

  /// Keeps all threads from the outputs as long as the result exists. Messages of isobard wait meanwhile.
  struct Pause {
    std::unique_lock<std::mutex> poses;
    std::unique_lock<std::mutex> clouds;
    std::unique_lock<std::mutex> floors;
  };
  [[nodiscard]] Pause pause() {
    return {std::unique_lock(pose_mutex_), std::unique_lock(cloud_mutex_), pause_floors()};
  }
  /// Keeps the thread of the floors, which makes writers, from the outputs.
  [[nodiscard]] std::unique_lock<std::mutex> pause_floors() {
    return floors_ ? floors_->pause() : std::unique_lock<std::mutex>();
  }
  /// Takes other settings, during a pause().
  void configure(const dds::DdsConfig& config);
  /// Starts or stops the thread of the clouds, outside of a pause(). Requires outputs for clouds while it runs.
  void set_clouds(bool are_published);
  /// Starts or stops the thread of the floors, outside of a pause(). Requires outputs for floors while it runs.
  void set_floors(bool are_published);
  /// See FloorForwarding::writer_count().
  [[nodiscard]] std::size_t floor_writer_count() const noexcept {
    return floors_ ? floors_->writer_count() : 0;
  }
  /// Ends all threads, for good. Outside of a pause().
  void stop();
  [[nodiscard]] bool has_clouds() const noexcept { return clouds_in_.has_value(); }
  /// Passes on the state of the network, for the diagnostics.
  void put_network(NetworkState state);
  /// Passes on the counts of the opposite direction, for the diagnostics. One thread.
  void put_received(const ReceivedCounts& counts) noexcept;
  /// Passes on the state of the inputs, for the diagnostics.
  void put_inputs(std::vector<InputState> states);
  /// Passes on the status of the keys, for the diagnostics. One thread.
  void put_keys(const KeyStatus& status) noexcept;
  [[nodiscard]] const IsobardClock& clock() const noexcept { return clock_; }
  /// Rounds of the pose thread: constant only while that thread hangs.
  [[nodiscard]] std::uint64_t rounds() const noexcept { return rounds_.load(std::memory_order_relaxed); }
  /// Time since the last message of isobard; zero before the first.
  [[nodiscard]] std::chrono::nanoseconds silence() const noexcept;

 private:
  /// Constructed only when clouds are published. The map is received only while somebody reads it: isobard builds
  /// map clouds only for a subscriber, and a large one takes 100 MB in either program.
  struct CloudsIn {
    CloudsIn();
    ipc::Subscriber<RegisteredScan> scan;
    std::optional<ipc::Subscriber<ipc::MapCloud>> map;
    std::int64_t map_read_ns = 0;  ///< when the map last had a reader, steady clock; 0: never
    ipc::Waiter waiter;            ///< of the scans: a piece of the map follows each
  };

  void follow_system_clock() noexcept;
  void forward_poses() noexcept;
  void forward_clouds() noexcept;
  void follow_map_readers();
  void forward_round();
  void forward_health();
  void add_own_health();
  void add_input_health();
  void add_station_health(const ReceivedCounts& received);
  void log_own_health();
  /// Adds an entry of the bridge.
  void add(const std::string& name, ipc::HealthLevel level, const std::string& message, double value);
  void note_data() noexcept;

  Outputs& outputs_;
  std::array<std::string, 2> station_topics_;
  ipc::Subscriber<Prior> prior_in_;
  ipc::Subscriber<PoseEstimate> pose_in_;
  ipc::Subscriber<PressureSample> station_in_;  ///< this base station's own pressure
  ipc::Subscriber<ipc::HealthReport> health_in_;
  ipc::Waiter pose_waiter_;
  std::optional<CloudsIn> clouds_in_;
  std::mutex pose_mutex_;                               ///< held by the pose thread while it uses the outputs
  std::mutex cloud_mutex_;                              ///< likewise
  NetworkState network_;                                ///< guarded by pose_mutex_
  std::vector<InputState> inputs_;                      ///< likewise
  std::optional<dds::DiagnosticsBuilder> diagnostics_;  ///< likewise; never empty
  std::vector<ipc::HealthEntry> last_entries_;          ///< of isobard; pose thread
  std::atomic<std::uint64_t> rounds_{0};
  std::atomic<std::int64_t> last_data_ns_{0};  ///< steady clock, 0: never
  std::atomic<std::uint64_t> clouds_dropped_{0};
  std::atomic<std::uint64_t> cloud_failures_{0};
  SeqLock<ReceivedCounts> received_;
  SeqLock<KeyStatus> keys_;
  ReceivedCounts last_received_;                      ///< pose thread
  std::map<std::string, std::uint64_t> last_counts_;  ///< pose thread, as all below
  ipc::HealthReport own_;                             ///< entries of the bridge
  ipc::HealthReport all_;                             ///< isobard's and the bridge's
  LevelHold hold_;
  LevelChanges changes_;
  IsobardClock clock_;
  std::optional<SystemClockWatch> system_clock_;  ///< pose thread; from the first health report on
  std::atomic<std::int64_t> stamp_shift_ns_{0};   ///< time of day minus robot clock
  std::int64_t last_report_ns_ = 0;               ///< steady clock; pose thread
  std::optional<FloorForwarding> floors_;
  std::thread pose_thread_;
  std::thread cloud_thread_;
};

}  // namespace isobar::bridge
