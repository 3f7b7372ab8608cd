// SPDX-License-Identifier: BSD-3-Clause
#include "tools/player.hpp"
#include "drivers/clock/robot_clock.hpp"

#include <thread>

namespace isobar::tools {
namespace {

datagram::Sample sample_of(const recording::Event& event) {
  datagram::Sample sample;
  switch (event.kind) {
    case recording::EventKind::kImu:
      sample.kind = datagram::Kind::kImu;
      sample.imu = event.imu;
      break;
    case recording::EventKind::kPressure:
      sample.kind = datagram::Kind::kPressure;
      sample.pressure = event.pressure;
      break;
    case recording::EventKind::kBasePressure:
      sample.kind = datagram::Kind::kBasePressure;
      sample.pressure = event.pressure;
      break;
    case recording::EventKind::kWheel:
      sample.kind = datagram::Kind::kWheel;
      sample.wheel = event.wheel;
      break;
    case recording::EventKind::kLidarPacket:
    case recording::EventKind::kCloud:
      break;
  }
  return sample;
}

}  // namespace

Player::Player(const std::string& address, const LidarPlan& lidar, std::uint16_t input_port)
    : lidar_(address, lidar.port),
      recorded_info_port_(lidar.recorded_info_port),
      samples_(address, input_port) {
  if (lidar.info_port != 0) information_.emplace(address, lidar.info_port);
}

std::int64_t Player::start(std::int64_t first_stamp_ns) {
  constexpr std::int64_t kPauseNs = 200'000'000;
  first_stamp_ns_ = first_stamp_ns;
  shift_ns_ = RobotClock::now_ns() + kPauseNs - first_stamp_ns;
  started_ = std::chrono::steady_clock::now() + std::chrono::nanoseconds(kPauseNs);
  return shift_ns_;
}

std::int64_t Player::send_when_due(const recording::Event& event) {
  std::this_thread::sleep_until(started_ + std::chrono::nanoseconds(event.stamp_ns - first_stamp_ns_));
  const std::int64_t sent_ns = RobotClock::now_ns();
  send(event);
  return sent_ns;
}

void Player::send(const recording::Event& event) {
  if (event.kind == recording::EventKind::kLidarPacket) {
    const bool is_information = information_ && event.port == recorded_info_port_;
    (is_information ? *information_ : lidar_).send(event.packet);
    return;
  }
  datagram::Sample sample = sample_of(event);
  sample.set_stamp_ns(sample.stamp_ns() + shift_ns_);
  sample.sequence = sequence_[static_cast<std::size_t>(sample.kind)]++;
  std::array<char, datagram::kMaxLineBytes> line{};
  const std::size_t length = datagram::format_line(sample, line);
  samples_.send({reinterpret_cast<const std::uint8_t*>(line.data()), length});
}

}  // namespace isobar::tools
