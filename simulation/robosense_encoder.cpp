// SPDX-License-Identifier: BSD-3-Clause
// Packets of RoboSense (RS-LiDAR-16 and RS-Helios-16P user manuals, appendices A and B). Data (MSOP): a header of
// 42 bytes, 12 blocks of two cycles of 16 lasers, 6 bytes at the end. Device information (DIFOP): the angles of
// the sensor's lasers. Big-endian.
#include <chrono>
#include <cmath>

#include "simulation/lidar_packet.hpp"

namespace isobar::simulation {

namespace {

constexpr std::size_t kMsopBytes = 1'248;
constexpr std::uint8_t kHelios = 6;

/// The sensor's clock without a source starts with the year 2024.
std::int64_t microseconds_since_1970(double sensor_s) {
  using namespace std::chrono;
  constexpr sys_days kStart = 2024y / 1 / 1;
  return microseconds(kStart.time_since_epoch()).count() + std::llround(sensor_s * 1e6);
}

/// RS-LiDAR-16: date, time of day, ms, us.
void put_calendar(PacketBytes& bytes, std::int64_t since_1970_us) {
  using namespace std::chrono;
  constexpr int kFirstYear = 2'000;
  const sys_time<microseconds> now{microseconds(since_1970_us)};
  const sys_days day = floor<days>(now);
  const year_month_day date(day);
  const hh_mm_ss time(now - day);
  put_big(bytes, static_cast<std::uint64_t>(static_cast<int>(date.year()) - kFirstYear), 1);
  put_big(bytes, static_cast<unsigned>(date.month()), 1);
  put_big(bytes, static_cast<unsigned>(date.day()), 1);
  put_big(bytes, static_cast<std::uint64_t>(time.hours().count()), 1);
  put_big(bytes, static_cast<std::uint64_t>(time.minutes().count()), 1);
  put_big(bytes, static_cast<std::uint64_t>(time.seconds().count()), 1);
  put_big(bytes, static_cast<std::uint64_t>(time.subseconds().count()) / 1'000, 2);
  put_big(bytes, static_cast<std::uint64_t>(time.subseconds().count()) % 1'000, 2);
}

void put_header(PacketBytes& bytes, const LidarPlan& plan, double sensor_s) {
  const std::int64_t us = microseconds_since_1970(sensor_s);
  if (plan.product == kHelios) {
    put_big(bytes, 0x55AA'055A, 4);
    put_big(bytes, 0x0001'0000, 4);  // version of the protocol
    bytes.resize(20);
    put_big(bytes, static_cast<std::uint64_t>(us / 1'000'000), 6);
    put_big(bytes, static_cast<std::uint64_t>(us % 1'000'000), 4);
  } else {
    put_big(bytes, 0x55AA'050A'5AA5'50A0, 8);
    bytes.resize(20);
    put_calendar(bytes, us);
  }
  put_big(bytes, plan.product, 1);
  bytes.resize(42);
}

/// Sign and 0.01 deg, of 32 channels.
void put_angles(PacketBytes& bytes, const LidarPlan& plan, const LidarPlan::Angles& angles_deg) {
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    const long counts = i < plan.lasers ? std::lround(100.0 * angles_deg[i]) : 0;
    put_big(bytes, counts < 0 ? 1 : 0, 1);
    put_big(bytes, static_cast<std::uint64_t>(std::abs(counts)), 2);
  }
}

}  // namespace

PacketBytes encode_robosense(const LidarPlan& plan, const LidarPacket& packet) {
  constexpr std::size_t kCyclesPerBlock = 2;
  PacketBytes bytes;
  put_header(bytes, plan, packet.sensor_s);
  for (std::size_t cycle = 0; cycle < packet.cycles.size(); ++cycle) {
    const FiringCycle& firing = packet.cycles[cycle];
    if (cycle % kCyclesPerBlock == 0) {
      put_big(bytes, 0xFFEE, 2);
      put_big(bytes, azimuth_counts(firing.azimuth_rad), 2);
    }
    for (std::size_t laser = 0; laser < plan.lasers; ++laser) {
      put_big(bytes, distance_counts(plan, firing.returns[laser].distance_m), 2);
      put_big(bytes, firing.returns[laser].reflectivity, 1);
    }
  }
  put_big(bytes, 0, 4);
  put_big(bytes, 0x00FF, 2);
  return bytes;
}

PacketBytes encode_angles(const LidarPlan& plan) {
  constexpr std::uint8_t kStrongest = 4;
  PacketBytes bytes;
  put_big(bytes, 0xA5FF'005A'1111'5555, 8);
  put_big(bytes, 600, 2);  // rpm
  bytes.resize(300);
  put_big(bytes, kStrongest, 1);
  bytes.resize(468);
  put_angles(bytes, plan, plan.elevation_deg);
  put_angles(bytes, plan, plan.azimuth_ahead_deg);
  bytes.resize(kMsopBytes - 2);
  put_big(bytes, 0x0FF0, 2);
  return bytes;
}

}  // namespace isobar::simulation
