// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lidar_thread.hpp"

#include <algorithm>

#include "daemon/receive_loop.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {

std::int64_t silence_limit_ns(const LidarStatus& lidar) {
  constexpr std::int64_t kWithoutEvidenceNs = 1'000'000'000;
  return lidar.waited_ns > lidar.last_packet_ns ? lidar.silence_ns
                                                : std::max(lidar.silence_ns, kWithoutEvidenceNs);
}

bool is_silent(const LidarStatus& lidar, std::int64_t now_ns) {
  return lidar.last_packet_ns != 0 && now_ns - lidar.last_packet_ns > silence_limit_ns(lidar);
}

LidarStatus status_of_clouds(std::uint64_t scans, std::int64_t last_scan_ns, const ArrivalMeter& arrivals) {
  LidarStatus status;
  status.counters.scans = scans;
  status.last_packet_ns = last_scan_ns;
  status.arrivals = arrivals;
  return status;
}

LidarThread::LidarThread(const StageSettings& stages, const LidarSettings& lidar, ThreadSettings settings)
    : receiver_(lidar.address, lidar.port, info_port_of(lidar)),
      configured_sender_(lidar.sender.empty() ? 0 : ipv4_of(lidar.sender)),
      sender_(lidar.sender),
      assembler_(make_lidar_decoder(stages.lidar), stages.lidar.time),
      publisher_(ipc::topics::kLidarScan),
      deadline_(settings.deadline_ms),
      worker_(std::move(settings), receiver_, [this] { loop(); }) {
  if (stages.imu_of_lidar) imu_publisher_.emplace(ipc::topics::kImu);
}

LidarThread::~LidarThread() {
  worker_.stop();
  if (loaned_ != nullptr) publisher_.discard(loaned_);
}

void LidarThread::loop() noexcept {
  loaned_ = publisher_.loan();
  receive_until_stopped(
      receiver_, worker_.heartbeat(),
      [this](const ReceivedDatagram& datagram) {
        datagram.second ? take_information(datagram) : take_packet(datagram);
      },
      [this] {
        tap_.end_round();
        if (!took_packet_) draft_status_.waited_ns = RobotClock::now_ns();
        took_packet_ = false;
        report();
        pause();
      });
}

void LidarThread::take_packet(const ReceivedDatagram& datagram) noexcept {
  took_packet_ = true;
  changes_.take([this](const Change& change) {
    assembler_.set_limits(change.limits);
    deadline_.set_limit(change.deadline_ms);
  });
  if (!sender_.admits(assembler_.decoder(), datagram.payload, datagram.sender.ipv4, datagram.stamp_ns))
    return;
  draft_status_.last_packet_ns = datagram.stamp_ns;
  tap_.add(datagram, ipc::LidarPort::kData);
  Scan& scan = loaned_ != nullptr ? *loaned_ : spare_scan_;
  const DecodeResult result = assembler_.add_packet(datagram.payload, datagram.stamp_ns, scan);
  if (result.status == DecodeStatus::kOk) {
    draft_status_.arrivals.add(assembler_.packet_stamp_ns(),
                               {datagram.stamp_ns, assembler_.clock_ahead_ns()});
  }
  if (result.scan_complete) publish_scan();
}

void LidarThread::take_information(const ReceivedDatagram& datagram) noexcept {
  const std::uint32_t in_use = sender_.status().in_use.ipv4;
  const std::uint32_t wanted = configured_sender_ != 0 ? configured_sender_ : in_use;
  if ((wanted != 0 && datagram.sender.ipv4 != wanted) || assembler_.decoder().is_data(datagram.payload)) {
    ++draft_status_.info_refused;
    return;
  }
  tap_.add(datagram, ipc::LidarPort::kInformation);
  (void)assembler_.add_packet(datagram.payload, datagram.stamp_ns,
                              loaned_ != nullptr ? *loaned_ : spare_scan_);
  ImuSample sample;
  while (imu_publisher_ && assembler_.take_imu(sample)) {
    sample.timing.received_ns = datagram.stamp_ns;
    if (!imu_publisher_->send(sample)) ++draft_status_.samples_without_memory;
  }
}

void LidarThread::publish_scan() noexcept {
  const std::int64_t end_stamp_ns = (loaned_ != nullptr ? *loaned_ : spare_scan_).end_stamp_ns;
  pacing_.scan_ended(end_stamp_ns);
  // A turn and a half without a packet is no pause of a reduced field of view.
  turns_.scanned(end_stamp_ns);
  if (turns_.known()) draft_status_.silence_ns = turns_.silence_ns();
  if (loaned_ != nullptr) {
    publisher_.publish(loaned_);
    deadline_.note(end_stamp_ns, RobotClock::now_ns());
  } else {
    ++draft_status_.scans_without_memory;
  }
  loaned_ = publisher_.loan();
}

// Drain the backlog before sleeping: pause only after a packet younger than a millisecond.
void LidarThread::pause() noexcept {
  constexpr std::int64_t kFreshNs = 1'000'000;
  constexpr std::int64_t kNsPerMs = 1'000'000;
  constexpr std::size_t kLargePacketBytes = 2'000;
  const std::int64_t now_ns = RobotClock::now_ns();
  if (now_ns - draft_status_.last_packet_ns > kFreshNs) return;
  // Samples of an IMU must not wait, and the socket's buffer holds few packets of several kilobytes.
  if (imu_publisher_ || assembler_.decoder().longest_packet() > kLargePacketBytes) return;
  if (const std::int64_t pause_ns = pacing_.pause_ns(now_ns); pause_ns > 0) {
    receiver_.pause(static_cast<int>(pause_ns / kNsPerMs));
  }
}

void LidarThread::report() noexcept {
  if (assembler_.counters().wrong_model > draft_status_.counters.wrong_model) {
    auto& message = draft_status_.wrong_model_message;
    assembler_.decoder().mismatch().copy(message.data(), message.size() - 1);
  }
  draft_status_.counters = assembler_.counters();
  draft_status_.sender = sender_.status();
  draft_status_.clock_jumped_ns = assembler_.clock_jumped_ns();
  draft_status_.contradiction = assembler_.decoder().contradiction();
  draft_status_.sync = assembler_.decoder().sync();
  draft_status_.sensor_stamps = assembler_.sensor_stamps();
  draft_status_.punctuality = deadline_.status();
  draft_status_.dropped_by_kernel = receiver_.dropped_by_kernel();
  status_.put(draft_status_);
}

}  // namespace isobar
