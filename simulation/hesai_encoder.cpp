// SPDX-License-Identifier: BSD-3-Clause
// Point cloud packets of Hesai's XT16 and XT32 (PandarXT user manuals, chapter 3): header, 8 blocks of an azimuth
// and the lasers' returns, tail with the UTC time of the sensor. The last block starts 5.632 us after that time.
#include <chrono>
#include <cmath>

#include "simulation/lidar_packet.hpp"

namespace isobar::simulation {

namespace {

/// Date and time of day, and microseconds.
void put_date_time(PacketBytes& bytes, double sensor_s) {
  using namespace std::chrono;
  constexpr sys_days kStart = 2024y / 1 / 1;  // the sensor's clock without a source
  constexpr int kFirstYear = 1'900;
  const auto us = std::llround(sensor_s * 1e6);
  const sys_days day = kStart + floor<days>(microseconds(us));
  const year_month_day date(day);
  const hh_mm_ss time(kStart + microseconds(us) - day);
  put_little(bytes, static_cast<std::uint64_t>(static_cast<int>(date.year()) - kFirstYear), 1);
  put_little(bytes, static_cast<unsigned>(date.month()), 1);
  put_little(bytes, static_cast<unsigned>(date.day()), 1);
  put_little(bytes, static_cast<std::uint64_t>(time.hours().count()), 1);
  put_little(bytes, static_cast<std::uint64_t>(time.minutes().count()), 1);
  put_little(bytes, static_cast<std::uint64_t>(time.seconds().count()), 1);
  put_little(bytes, static_cast<std::uint64_t>(time.subseconds().count()), 4);
}

}  // namespace

PacketBytes encode_hesai(const LidarPlan& plan, const LidarPacket& packet) {
  constexpr std::uint8_t kStrongest = 0x37;
  constexpr double kLastBlockS = 5.632e-6;  // its start, after the time of the packet
  PacketBytes bytes;
  put_big(bytes, 0xEEFF, 2);  // start of packet
  put_big(bytes, 0x0601, 2);  // protocol 6.1
  put_big(bytes, 0, 2);
  put_little(bytes, plan.lasers, 1);
  put_little(bytes, packet.cycles.size(), 1);                                    // blocks
  put_little(bytes, 1, 1);                                                       // first block: last return
  put_little(bytes, static_cast<std::uint64_t>(plan.distance_unit_m * 1e3), 1);  // mm
  put_little(bytes, 1, 1);                                                       // returns of a laser
  put_little(bytes, 1, 1);                                                       // flags: a sequence number
  for (const FiringCycle& cycle : packet.cycles) {
    put_little(bytes, azimuth_counts(cycle.azimuth_rad), 2);
    for (std::size_t laser = 0; laser < plan.lasers; ++laser) {
      const LaserReturn& measured = cycle.returns[laser];
      put_little(bytes, distance_counts(plan, measured.distance_m), 2);
      put_little(bytes, measured.reflectivity, 1);
      put_little(bytes, 0, 1);
    }
  }
  bytes.resize(bytes.size() + 10);  // reserved
  put_little(bytes, kStrongest, 1);
  put_little(bytes, static_cast<std::uint64_t>(std::lround(60.0 * packet.turn_hz)), 2);
  const double to_last_s = packet.cycle_s * static_cast<double>(packet.cycles.size() - 1);
  put_date_time(bytes, packet.sensor_s + to_last_s - kLastBlockS);
  put_little(bytes, 0x42, 1);  // factory
  put_little(bytes, packet.number, 4);
  return bytes;
}

}  // namespace isobar::simulation
