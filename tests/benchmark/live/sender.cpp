// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/live/sender.hpp"

#include <memory>

#include "config/config.hpp"
#include "core/samples.hpp"
#include "daemon/realtime.hpp"
#include "daemon/stage_settings.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "tools/player.hpp"

namespace isobar::benchmark {
namespace {

/// Priority above all threads of isobard, because a real sensor does not compete for the robot's processor.
constexpr int kPriority = 60;

}  // namespace

Sender::Sender(const std::filesystem::path& recording, std::uint16_t lidar_port)
    : thread_([this, recording, lidar_port] { play(recording, lidar_port); }) {}

Sender::~Sender() {
  stopping_ = true;
  thread_.join();
}

std::vector<Event> Sender::scans() const {
  const std::lock_guard lock(mutex_);
  return scans_;
}

std::vector<Event> Sender::imu_samples() const {
  const std::lock_guard lock(mutex_);
  return imu_samples_;
}

void Sender::note(std::vector<Event>& to, const Event& event) {
  const std::lock_guard lock(mutex_);
  to.push_back(event);
}

void Sender::play(const std::filesystem::path& recording, std::uint16_t lidar_port) {
  (void)apply_to_this_thread({"sender", kPriority, {}});  // without rights: ordinary scheduling
  recording::RecordingReader reader(recording);
  // The decoder identifies the packet that closes a scan.
  ScanAssembler decoder(
      make_lidar_decoder(stage_settings(with_sensors_of(reader.manifest(), Config{})).lidar));
  const auto scan = std::make_unique<Scan>();
  tools::Player player("127.0.0.1", {.port = lidar_port}, datagram::kDefaultPort);
  recording::Event event;
  for (std::int64_t shift_ns = 0; !stopping_ && reader.next(event);) {
    if (shift_ns == 0) shift_ns = player.start(event.stamp_ns);
    const std::int64_t sent_ns = player.send_when_due(event);
    if (event.kind == recording::EventKind::kImu) note(imu_samples_, {event.stamp_ns + shift_ns, sent_ns});
    if (event.kind == recording::EventKind::kLidarPacket &&
        decoder.add_packet(event.packet, event.stamp_ns, *scan).scan_complete) {
      note(scans_, {scan->end_stamp_ns + shift_ns, sent_ns});
    }
  }
  ended_ = !stopping_;
}

}  // namespace isobar::benchmark
