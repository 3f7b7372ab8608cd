// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "config/config.hpp"
#include "daemon/arrival_meter.hpp"
#include "daemon/deadline.hpp"
#include "daemon/handover.hpp"
#include "daemon/lidar_sender.hpp"
#include "daemon/packet_pacing.hpp"
#include "daemon/packet_tap.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/silence_bridge.hpp"
#include "daemon/stage_settings.hpp"
#include "daemon/worker.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "drivers/udp/udp_pair.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the lidar thread.
struct LidarStatus {
  LidarCounters counters;
  std::uint64_t dropped_by_kernel = 0;
  std::uint64_t samples_without_memory = 0;  ///< samples of the lidar's IMU
  std::uint64_t info_refused = 0;            ///< packets of the second port that another machine sent
  std::uint64_t scans_without_memory = 0;    ///< complete scans dropped for want of a chunk in shared memory
  std::int64_t last_packet_ns = 0;           ///< robot clock; 0: none yet
  std::int64_t waited_ns = 0;                ///< robot clock, end of the last wait without a data packet
  std::int64_t silence_ns = 1'000'000'000;   ///< time without a packet that no working lidar takes
  ArrivalMeter arrivals;                     ///< of the packets; of clouds over DDS, of these
  SenderStatus sender;                       ///< port 0
  std::int64_t clock_jumped_ns = 0;          ///< last jump of the lidar's clock, robot clock; 0: never
  LidarSync sync = LidarSync::kUnknown;      ///< state of the lidar's clock
  bool sensor_stamps = false;                ///< the last scan was stamped by that clock
  DeadlineStatus punctuality;                ///< from the end of a scan to its publication
  const char* contradiction = nullptr;       ///< see LidarDecoder::contradiction()
  /// Names the configured and the received model; empty while all packets are of the configured one.
  std::array<char, 120> wrong_model_message{};
};

/// Time without a packet after which a lidar is silent [ns]. A second while its thread has not waited in vain since the
/// last packet: the thread had no processor time, and packets may be waiting for it.
[[nodiscard]] std::int64_t silence_limit_ns(const LidarStatus& lidar);
/// Whether a lidar that has sent sends no longer.
[[nodiscard]] bool is_silent(const LidarStatus& lidar, std::int64_t now_ns);

/// What isobard knows of a lidar whose scans isobar-dds converts: their number and times.
[[nodiscard]] LidarStatus status_of_clouds(std::uint64_t scans, std::int64_t last_scan_ns,
                                           const ArrivalMeter& arrivals);

/// Decodes the lidar's UDP packets and publishes scans. Its other packets (position, device information, IMU)
/// come to a second port.
class LidarThread {
 public:
  /// @throws ConfigError for a calibration file that cannot be used; ServiceError when the port may not be used; an address or port that is not there yet is waited for
  LidarThread(const StageSettings& stages, const LidarSettings& lidar, ThreadSettings settings);
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
  [[nodiscard]] std::uint16_t port() const noexcept { return receiver_.first().port(); }
  /// See UdpReceiver::waiting_for().
  [[nodiscard]] std::string waiting_for() const { return receiver_.first().waiting_for(); }
  /// The same of the second port.
  [[nodiscard]] std::string info_waiting_for() const {
    return receiver_.second() != nullptr ? receiver_.second()->waiting_for() : std::string{};
  }

 private:
  struct Change {
    LidarLimits limits;
    double deadline_ms;
  };
  void loop() noexcept;
  void take_packet(const ReceivedDatagram& datagram) noexcept;
  void take_information(const ReceivedDatagram& datagram) noexcept;
  void publish_scan() noexcept;
  void report() noexcept;
  void pause() noexcept;

  UdpPair receiver_;
  std::uint32_t configured_sender_;  ///< 0: any
  LidarSender sender_;
  ScanAssembler assembler_;
  ipc::Publisher<Scan> publisher_;
  std::optional<ipc::Publisher<ImuSample>> imu_publisher_;  ///< imu.source is lidar
  Scan* loaned_ = nullptr;
  Scan
      spare_scan_;  ///< decoded into while no chunk is free, so that the next scan starts at the right packet
  PacketTap tap_;
  PacketPacing pacing_;
  SilenceBridge turns_;       ///< learns how long a turn takes
  bool took_packet_ = false;  ///< in this round
  Deadline deadline_;
  Handover<Change> changes_;
  LidarStatus draft_status_;
  SeqLock<LidarStatus> status_;
  Worker worker_;
};

}  // namespace isobar
