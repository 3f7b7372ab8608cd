// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lidar_thread.hpp"

#include "daemon/receive_loop.hpp"

namespace isobar {

LidarThread::LidarThread(const velodyne::VelodyneConfig& config, const std::string& address,
                         std::uint16_t port, ThreadSettings settings)
    : settings_(std::move(settings)),
      receiver_(address, port),
      decoder_(config),
      publisher_(ipc::topics::kLidarScan),
      deadline_(settings_.deadline_ms) {}

LidarThread::~LidarThread() {
  stop();
  if (loaned_ != nullptr) publisher_.discard(loaned_);
}

void LidarThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void LidarThread::stop() noexcept {
  receiver_.stop();
  if (thread_.joinable()) thread_.join();
}

void LidarThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  loaned_ = publisher_.loan();
  receive_until_stopped(
      receiver_, heartbeat_, [this](const ReceivedDatagram& datagram) { take_packet(datagram); },
      [this] {
        report();
        pause();
      });
}

void LidarThread::take_packet(const ReceivedDatagram& datagram) noexcept {
  own_.last_packet_ns = datagram.stamp_ns;
  Scan& scan = loaned_ != nullptr ? *loaned_ : unpublished_;
  if (decoder_.add_packet(datagram.payload, datagram.stamp_ns, scan).scan_complete) hand_over();
}

void LidarThread::hand_over() noexcept {
  pacing_.scan_ended((loaned_ != nullptr ? *loaned_ : unpublished_).end_stamp_ns);
  if (loaned_ != nullptr) {
    const std::int64_t end_ns = loaned_->end_stamp_ns;
    publisher_.publish(loaned_);
    deadline_.note(end_ns, RobotClock::now_ns());
  } else {
    ++own_.scans_without_memory;
  }
  loaned_ = publisher_.loan();
}

// Only after a packet that is of now: what has gathered in the socket is fetched first.
void LidarThread::pause() noexcept {
  constexpr std::int64_t kOfNowNs = 1'000'000;
  constexpr std::int64_t kNsPerMs = 1'000'000;
  const std::int64_t now_ns = RobotClock::now_ns();
  if (now_ns - own_.last_packet_ns > kOfNowNs) return;
  if (const std::int64_t pause_ns = pacing_.pause_ns(now_ns); pause_ns > 0) {
    receiver_.pause(static_cast<int>(pause_ns / kNsPerMs));
  }
}

void LidarThread::report() noexcept {
  if (decoder_.counters().wrong_model > own_.counters.wrong_model) {
    decoder_.wrong_model_message().copy(own_.wrong_model_message.data(), own_.wrong_model_message.size() - 1);
  }
  own_.counters = decoder_.counters();
  own_.punctuality = deadline_.status();
  own_.dropped_by_kernel = receiver_.dropped_by_kernel();
  status_.put(own_);
}

}  // namespace isobar
