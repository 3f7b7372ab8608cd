// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <thread>

#include "core/time/base_station_stream.hpp"
#include "core/time/clock_anchor.hpp"
#include "daemon/realtime.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker_watch.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/datagram/udp.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the inertial thread says of itself.
struct InertialStatus {
  datagram::Counters counters;
  std::uint64_t clock_steps = 0;  ///< senders' clocks that were set
  std::uint64_t dropped_by_kernel = 0;
  std::uint64_t samples_without_memory = 0;
  std::uint64_t refused_pressure = 0;  ///< of a barometer that this machine reads itself
  std::uint64_t not_of_this_role = 0;  ///< samples that a base station has no use for
  BaseStationStatus base;              ///< of the base station that sends datagrams
};

/// Sample datagrams of IMU, barometers and wheels in, samples on the robot's clock out.
class InertialThread {
 public:
  /// What is taken; the rest is refused and counted.
  struct Takes {
    bool barometer = true;  ///< false where another thread writes the barometer's topic
    bool others = true;     ///< false on a base station
  };
  /// Throws ServiceError when the port cannot be bound.
  InertialThread(const std::string& address, std::uint16_t port, Takes takes, ThreadSettings settings);
  ~InertialThread();
  InertialThread(const InertialThread&) = delete;
  InertialThread& operator=(const InertialThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] InertialStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.port(); }
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void loop() noexcept;
  void take_datagram(const ReceivedDatagram& received) noexcept;
  [[nodiscard]] bool to_robot_clock(datagram::Sample& sample, const ReceivedDatagram& received) noexcept;
  bool publish(const datagram::Sample& sample) noexcept;
  void report() noexcept;

  ThreadSettings settings_;
  Takes takes_;
  UdpReceiver receiver_;
  datagram::DatagramParser parser_;
  std::array<ClockAnchor, datagram::kKinds> anchors_;  ///< every sender may have a clock of its own
  BaseStationStream base_;
  ipc::Publisher<ImuSample> imu_;
  ipc::Publisher<PressureSample> barometer_;
  ipc::Publisher<PressureSample> base_barometer_;
  ipc::Publisher<WheelSample> wheel_;
  InertialStatus own_;
  SeqLock<InertialStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar
