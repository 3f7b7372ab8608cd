// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <thread>

#include "core/time/clock_anchor.hpp"
#include "daemon/mailbox.hpp"
#include "daemon/realtime.hpp"
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
};

/// Sample datagrams of IMU, barometers and wheels in, samples on the robot's clock out.
class InertialThread {
 public:
  /// takes_pressure: false where another thread writes the barometer's topic; datagrams of it are then
  /// refused and counted. Throws ServiceError when the port cannot be bound.
  InertialThread(const std::string& address, std::uint16_t port, bool takes_pressure,
                 ThreadSettings settings);
  ~InertialThread();
  InertialThread(const InertialThread&) = delete;
  InertialThread& operator=(const InertialThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] InertialStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.port(); }

 private:
  void loop() noexcept;
  void take_datagram(const ReceivedDatagram& received) noexcept;
  void to_robot_clock(datagram::Sample& sample, std::int64_t receive_ns) noexcept;
  bool publish(const datagram::Sample& sample) noexcept;
  void report() noexcept;

  ThreadSettings settings_;
  bool takes_pressure_;
  UdpReceiver receiver_;
  datagram::DatagramParser parser_;
  std::array<ClockAnchor, datagram::kKinds> anchors_;  ///< every sender may have a clock of its own
  ipc::Publisher<ImuSample> imu_;
  ipc::Publisher<PressureSample> barometer_;
  ipc::Publisher<PressureSample> base_barometer_;
  ipc::Publisher<WheelSample> wheel_;
  InertialStatus own_;
  Mailbox<InertialStatus> status_;
  std::thread thread_;
};

}  // namespace isobar
