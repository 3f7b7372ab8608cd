// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>

#include "config/config.hpp"
#include "core/time/stream_pace.hpp"
#include "daemon/deadline.hpp"
#include "daemon/handover.hpp"
#include "daemon/lidar_sender.hpp"
#include "daemon/packet_pacing.hpp"
#include "daemon/packet_tap.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "drivers/udp/udp.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the lidar thread.
struct LidarStatus {
  LidarCounters counters;
  std::uint64_t dropped_by_kernel = 0;
  std::uint64_t scans_without_memory = 0;  ///< complete scans dropped for want of a chunk in shared memory
  std::int64_t last_packet_ns = 0;         ///< robot clock; 0: none yet
  StreamPace pace;                         ///< of the scans' ends
  SenderStatus sender;                     ///< port 0
  std::int64_t clock_jumped_ns = 0;        ///< last jump of the lidar's clock, robot clock; 0: never
  DeadlineStatus punctuality;              ///< from the end of a scan to its publication
  /// Names the configured and the received model; empty while all packets are of the configured one.
  std::array<char, 120> wrong_model_message{};
};

/// Decodes the lidar's UDP packets and publishes scans.
class LidarThread {
 public:
  /// @throws ConfigError for a calibration file that cannot be used; ServiceError when the port may not be used; an address or port that is not there yet is waited for
  LidarThread(const LidarConfig& config, const LidarSettings& lidar, ThreadSettings settings);
  ~LidarThread();
  LidarThread(const LidarThread&) = delete;
  LidarThread& operator=(const LidarThread&) = delete;

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  /// Changes the range and the masked sector of the returns, and the deadline, from the next packet on. Main
  /// thread, as collect().
  void configure(const LidarLimits& limits, double deadline_ms) {
    changes_.offer(std::make_unique<Change>(Change{limits, deadline_ms}));
  }
  void collect() { changes_.collect(); }

  [[nodiscard]] LidarStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.port(); }
  /// See UdpReceiver::waiting_for().
  [[nodiscard]] std::string waiting_for() const { return receiver_.waiting_for(); }

 private:
  struct Change {
    LidarLimits limits;
    double deadline_ms;
  };
  void loop() noexcept;
  void take_packet(const ReceivedDatagram& datagram) noexcept;
  void publish_scan() noexcept;
  void report() noexcept;
  void pause() noexcept;

  UdpReceiver receiver_;
  LidarSender sender_;
  ScanAssembler assembler_;
  ipc::Publisher<Scan> publisher_;
  Scan* loaned_ = nullptr;
  Scan
      spare_scan_;  ///< decoded into while no chunk is free, so that the next scan starts at the right packet
  PacketTap tap_;
  PacketPacing pacing_;
  Deadline deadline_;
  Handover<Change> changes_;
  LidarStatus draft_status_;
  SeqLock<LidarStatus> status_;
  Worker worker_;
};

}  // namespace isobar
