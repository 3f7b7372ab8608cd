// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "daemon/sample_input.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "drivers/udp/udp.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the sample thread.
struct SampleThreadStatus : SampleInputStatus {
  std::uint64_t dropped_by_kernel = 0;
  std::uint64_t samples_without_memory = 0;
};

/// Receives sample datagrams of IMU, barometer, base station and wheels and publishes samples stamped on the
/// robot clock. The configuration keys and the thread's own name call it `inertial`.
class SampleThread {
 public:
  /// @param senders addresses whose datagrams are taken; empty: any
  /// @throws ServiceError when the port may not be used; an address or port that is not there yet is waited for
  SampleThread(const std::string& address, std::uint16_t port, SampleInput::Takes takes,
               const std::string& senders, ThreadSettings settings);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] SampleThreadStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.port(); }
  /// See UdpReceiver::waiting_for().
  [[nodiscard]] std::string waiting_for() const { return receiver_.waiting_for(); }

 private:
  void loop() noexcept;
  void take_datagram(const ReceivedDatagram& received) noexcept;
  bool publish(const datagram::Sample& sample) noexcept;
  void report() noexcept;

  UdpReceiver receiver_;
  SampleInput input_;
  ipc::Publisher<ImuSample> imu_;
  ipc::Publisher<PressureSample> barometer_;
  ipc::Publisher<PressureSample> base_barometer_;
  ipc::Publisher<WheelSample> wheel_;
  SampleThreadStatus draft_status_;
  SeqLock<SampleThreadStatus> status_;
  Worker worker_;
};

}  // namespace isobar
