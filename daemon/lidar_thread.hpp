// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <thread>

#include "daemon/deadline.hpp"
#include "daemon/packet_pacing.hpp"
#include "daemon/realtime.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker_watch.hpp"
#include "drivers/datagram/udp.hpp"
#include "drivers/velodyne/velodyne_decoder.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the lidar thread says of itself.
struct LidarStatus {
  velodyne::VelodyneCounters counters;
  std::uint64_t dropped_by_kernel = 0;
  std::uint64_t scans_without_memory = 0;  ///< complete scans that found no chunk in shared memory
  std::int64_t last_packet_ns = 0;         ///< robot clock, 0: none yet
  DeadlineStatus punctuality;              ///< from the end of a scan to the scan handed on
  std::array<char, 120>
      wrong_model_message{};  ///< names both models; empty while all packets are of the right one
};

/// UDP packets of the lidar in, scans out.
class LidarThread {
 public:
  /// Throws ServiceError when the port cannot be bound.
  LidarThread(const velodyne::VelodyneConfig& config, const std::string& address, std::uint16_t port,
              ThreadSettings settings);
  ~LidarThread();
  LidarThread(const LidarThread&) = delete;
  LidarThread& operator=(const LidarThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] LidarStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.port(); }
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void loop() noexcept;
  void take_packet(const ReceivedDatagram& datagram) noexcept;
  void hand_over() noexcept;
  void report() noexcept;
  void pause() noexcept;

  ThreadSettings settings_;
  UdpReceiver receiver_;
  velodyne::VelodyneDecoder decoder_;
  ipc::Publisher<Scan> publisher_;
  Scan* loaned_ = nullptr;
  Scan unpublished_;  ///< decoded into while no chunk is free, so that the revolution stays in step
  PacketPacing pacing_;
  Deadline deadline_;
  LidarStatus own_;
  SeqLock<LidarStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar
