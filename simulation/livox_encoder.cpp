// SPDX-License-Identifier: BSD-3-Clause
// Point cloud packets of a Mid-360 (Livox SDK communication protocol, Mid-360, chapters 2 and 6), data type 1: a
// header of 36 bytes, then x, y, z in mm (32 bits), reflectivity and tag of each point. CRC-32 of IEEE 802.3 over
// everything behind it.
#include <array>
#include <cmath>
#include <span>

#include "simulation/lidar_packet.hpp"

namespace isobar::simulation {

namespace {

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1U) ^ ((value & 1U) != 0 ? 0xEDB8'8320U : 0U);
    table[i] = value;
  }
  return table;
}();

std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFF'FFFF;
  for (const std::uint8_t byte : bytes) crc = (crc >> 8U) ^ kCrcTable[(crc ^ byte) & 0xFFU];
  return ~crc;
}

void put_point(PacketBytes& bytes, const LaserReturn& measured) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto mm = static_cast<std::int32_t>(std::lround(1e3 * measured.distance_m * measured.beam[axis]));
    put_little(bytes, static_cast<std::uint32_t>(mm), 4);
  }
  put_little(bytes, measured.reflectivity, 1);
  put_little(bytes, 0, 1);  // tag: a good point
}

}  // namespace

PacketBytes encode_livox(const LidarPlan& plan, const LidarPacket& packet) {
  const std::size_t points = packet.cycles.size() * plan.lasers;
  PacketBytes checked;
  put_little(checked, static_cast<std::uint64_t>(std::llround(1e9 * packet.sensor_s)), 8);
  for (const FiringCycle& cycle : packet.cycles) {
    for (std::size_t laser = 0; laser < plan.lasers; ++laser) put_point(checked, cycle.returns[laser]);
  }
  const double interval_s =
      packet.cycle_s / static_cast<double>(plan.lasers) * static_cast<double>(points - 1);
  constexpr std::size_t kHeaderBytes = 28;
  PacketBytes bytes;
  put_little(bytes, 0, 1);  // version
  put_little(bytes, kHeaderBytes + checked.size(), 2);
  put_little(bytes, static_cast<std::uint64_t>(std::lround(1e7 * interval_s)),
             2);  // 0.1 us, first to last point
  put_little(bytes, points, 2);
  put_little(bytes, packet.number, 2);
  put_little(bytes, 0, 1);   // number of the frame: none without a repeated pattern
  put_little(bytes, 1, 1);   // data type: mm in 32 bits
  put_little(bytes, 0, 1);   // time: since the sensor's start
  put_little(bytes, 0, 12);  // reserved
  put_little(bytes, crc_of(checked), 4);
  bytes.insert(bytes.end(), checked.begin(), checked.end());
  return bytes;
}

}  // namespace isobar::simulation
