// SPDX-License-Identifier: BSD-3-Clause
// From DDS to shared memory: samples of ROS 2 nodes and base stations, for isobard.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/time/clock_anchor.hpp"
#include "core/time/system_clock_watch.hpp"
#include "daemon/bridge/cloud_input.hpp"
#include "daemon/bridge/pose_hint_input.hpp"
#include "daemon/bridge/settings.hpp"
#include "daemon/bridge/station_input.hpp"
#include "daemon/bridge/writer_choice.hpp"
#include "daemon/seq_lock.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/writer_watch.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// The robot clock of isobard, read from this process: CLOCK_MONOTONIC plus the offset in isobard's health
/// report. Any thread.
class IsobardClock {
 public:
  /// @param offset_ns HealthReport::robot_clock_offset_ns
  void set_offset_ns(std::int64_t offset_ns) noexcept {
    offset_ns_.store(offset_ns, std::memory_order_relaxed);
  }
  [[nodiscard]] bool known() const noexcept { return offset_ns_.load(std::memory_order_relaxed) != kUnknown; }
  /// Meaningless before known().
  [[nodiscard]] std::int64_t now_ns() const noexcept;

 private:
  static constexpr std::int64_t kUnknown = INT64_MIN;
  std::atomic<std::int64_t> offset_ns_{kUnknown};
};

/// Counts of received messages, for the diagnostics.
struct ReceivedCounts {
  std::uint64_t refused = 0;        ///< implausible
  std::uint64_t other_senders = 0;  ///< of a second IMU or of second wheels
  std::uint64_t too_early = 0;      ///< no clock of isobard yet, or no free chunk in shared memory
  RefusedHints refused_hints;
  /// Base stations with readers, [0 … station_count-1].
  std::array<BaseStationStatus, 2> stations;
  std::size_t station_count = 0;
  std::int64_t taken_ns = 0;  ///< when the counts were taken, robot clock
};

/// State of an input.
struct InputState {
  const char* input;  ///< its name in the settings, "imu"
  std::string
      trouble;  ///< why nothing comes although a node writes it, with the remedy; empty: nothing is wrong
};

/// Readers of the configured topics, and the thread that forwards their samples.
class Receiving {
 public:
  /// @param of_stations participant of the base stations' topics; 0: they are not received
  /// @throws ServiceError when a DDS entity cannot be created
  Receiving(dds_entity_t participant, dds_entity_t of_stations, const Settings& settings,
            const IsobardClock& clock);
  ~Receiving();
  Receiving(const Receiving&) = delete;
  Receiving& operator=(const Receiving&) = delete;

  [[nodiscard]] ReceivedCounts counts() const noexcept;
  [[nodiscard]] std::vector<dds_entity_t> readers() const;
  /// Whether the writers of the inputs fit. Of base stations the first one. Main thread.
  [[nodiscard]] std::vector<InputState> states();

 private:
  /// The inputs of one participant, and the writers that it has found.
  struct Watched {
    dds::WriterWatch writers;
    std::vector<dds::InputReader> inputs;
  };
  /// Path of one topic: DDS reader, mapping of the sender's clock to the robot clock, shared-memory
  /// publisher.
  template <class Message, class Sample>
  struct Stream {
    dds::Reader<Message> reader;
    ipc::Publisher<Sample> publisher;
    ClockAnchor anchor;
    SenderClock sender_clock;
    bool anchored = false;
    WriterChoice writer;

    Stream(dds_entity_t participant, const dds::DdsTopic<Message>& from, const std::string& ros_namespace,
           const std::string& ros_name, const dds::InputQos& qos, const ipc::Topic<Sample>& to)
        : reader(participant, from, ros_namespace, ros_name, qos), publisher(to) {}
  };

  template <class Message, class Sample>
  void forward(std::optional<Stream<Message, Sample>>& stream);
  void forward_cloud();
  void forward_hints();
  void forward_stations();
  void wait_for_data(dds_entity_t participant);
  void watch_writers(dds_entity_t participant, dds_entity_t of_stations);
  void loop() noexcept;

  const IsobardClock& clock_;
  SystemClockWatch system_clock_{0};  ///< its steps, which ROS 2 nodes of this machine share
  std::vector<std::unique_ptr<StationInput>> stations_;
  std::optional<ipc::Publisher<PressureSample>> base_pressure_;
  std::unique_ptr<CloudInput> cloud_;
  std::unique_ptr<PoseHintInput> hints_;
  std::optional<Stream<dds::PressureMessage, PressureSample>> pressure_;
  std::optional<Stream<dds::ImuMessage, ImuSample>> imu_;
  std::optional<Stream<dds::OdometryMessage, WheelSample>> wheel_;
  std::optional<Stream<dds::TwistMessage, WheelSample>> wheel_twist_;
  std::vector<Watched> watched_;
  bool imu_orientation_;
  dds::Entity waitset_;
  dds::Entity stop_;
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> too_early_{0};
  std::atomic<std::uint64_t> other_senders_{0};
  SeqLock<std::array<BaseStationStatus, 2>> station_status_;
  SeqLock<RefusedHints> refused_hints_;
  std::thread thread_;
};

}  // namespace isobar::bridge
