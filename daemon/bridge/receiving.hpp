// SPDX-License-Identifier: BSD-3-Clause
// The way in: what ROS 2 nodes and base stations measure goes to isobard through shared memory.
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
#include "daemon/bridge/settings.hpp"
#include "daemon/bridge/station_input.hpp"
#include "daemon/seq_lock.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// isobard's clock: the monotonic clock and an offset that only isobard knows and that never changes while it
/// lives. Every stamp that it gives out bounds the offset from below; the largest bound is late by the
/// fastest way through shared memory, a tenth of a millisecond. Any thread.
class RobotClock {
 public:
  /// isobard said at this moment that it is `stamp_ns`. One thread.
  void note(std::int64_t stamp_ns) noexcept;
  [[nodiscard]] bool known() const noexcept { return offset_ns_.load(std::memory_order_relaxed) != kUnknown; }
  [[nodiscard]] std::int64_t now_ns() const noexcept;

 private:
  static constexpr std::int64_t kUnknown = INT64_MIN;
  std::atomic<std::int64_t> offset_ns_{kUnknown};
};

/// What came in, for the diagnostics.
struct ReceivedCounts {
  std::uint64_t samples = 0;
  std::uint64_t refused = 0;    ///< implausible
  std::uint64_t too_early = 0;  ///< before isobard's clock was known, or without room in shared memory
  /// The base stations that are listened to, [0 … station_count-1].
  std::array<BaseStationStatus, 2> stations;
  std::size_t station_count = 0;
  std::int64_t taken_ns = 0;  ///< robot clock, when this was true
};

/// Readers of the topics that the configuration asks for, and one thread that hands on what they get.
class Receiving {
 public:
  /// @throws ServiceError DDS or shared memory refuses
  Receiving(dds_entity_t participant, const Settings& settings, const RobotClock& clock);
  ~Receiving();
  Receiving(const Receiving&) = delete;
  Receiving& operator=(const Receiving&) = delete;

  [[nodiscard]] ReceivedCounts counts() const noexcept;
  [[nodiscard]] std::vector<dds_entity_t> readers() const;

 private:
  /// One topic's way: from the sender's clock to the robot's, from DDS to shared memory.
  template <class Message, class Sample>
  struct Stream {
    dds::Reader<Message> reader;
    ipc::Publisher<Sample> publisher;
    ClockAnchor anchor;

    Stream(dds_entity_t participant, const dds::DdsTopic<Message>& from, const std::string& ros_namespace,
           const ipc::Topic<Sample>& to)
        : reader(participant, from, ros_namespace), publisher(to) {}
  };

  template <class Message, class Sample>
  void forward(std::optional<Stream<Message, Sample>>& stream);
  void forward_stations();
  void loop() noexcept;

  const RobotClock& clock_;
  std::vector<std::unique_ptr<StationInput>> stations_;
  std::optional<ipc::Publisher<PressureSample>> base_pressure_;
  std::optional<Stream<dds::ImuMessage, ImuSample>> imu_;
  std::optional<Stream<dds::OdometryMessage, WheelSample>> wheel_;
  dds::Entity waitset_;
  dds::Entity stop_;
  std::atomic<std::uint64_t> samples_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> too_early_{0};
  SeqLock<std::array<BaseStationStatus, 2>> station_status_;
  std::thread thread_;
};

}  // namespace isobar::bridge
