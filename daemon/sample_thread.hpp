// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "core/time/base_station_stream.hpp"
#include "core/time/clock_anchor.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/udp/udp.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the sample thread.
struct SampleThreadStatus {
  datagram::Counters counters;
  std::uint64_t clock_steps = 0;  ///< times that a sender's clock was set
  std::uint64_t dropped_by_kernel = 0;
  std::uint64_t samples_without_memory = 0;
  std::uint64_t refused_pressure = 0;  ///< pressure datagrams while this machine reads the barometer itself
  std::uint64_t not_of_this_role = 0;  ///< IMU, wheel and base samples received by a base station
  BaseStationStatus base;              ///< of the base station that sends datagrams
};

/// Receives sample datagrams of IMU, barometer, base station and wheels and publishes samples stamped on the
/// robot clock. The configuration keys and the thread's own name call it `inertial`.
class SampleThread {
 public:
  /// Kinds of samples that are published; others are refused and counted.
  struct Takes {
    bool barometer = true;  ///< false where a BarometerThread writes the barometer topic
    bool others = true;     ///< false on a base station
  };
  /// @throws ServiceError when the port cannot be bound
  SampleThread(const std::string& address, std::uint16_t port, Takes takes, ThreadSettings settings);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] SampleThreadStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.port(); }

 private:
  void loop() noexcept;
  void take_datagram(const ReceivedDatagram& received) noexcept;
  [[nodiscard]] bool to_robot_clock(datagram::Sample& sample, const ReceivedDatagram& received) noexcept;
  bool publish(const datagram::Sample& sample) noexcept;
  void report() noexcept;

  Takes takes_;
  UdpReceiver receiver_;
  datagram::DatagramParser parser_;
  std::array<ClockAnchor, datagram::kKinds> anchors_;  ///< each sender may stamp with its own clock
  BaseStationStream base_;
  ipc::Publisher<ImuSample> imu_;
  ipc::Publisher<PressureSample> barometer_;
  ipc::Publisher<PressureSample> base_barometer_;
  ipc::Publisher<WheelSample> wheel_;
  SampleThreadStatus draft_status_;
  SeqLock<SampleThreadStatus> status_;
  Worker worker_;
};

}  // namespace isobar
