// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/vlp16_encoder.hpp"

#include <cmath>
#include <numbers>

namespace isobar::simulation {

namespace {

void put_u16(Vlp16Bytes& bytes, std::size_t at, std::uint32_t value) {
  bytes[at] = static_cast<std::uint8_t>(value & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>((value >> 8U) & 0xFFU);
}

std::uint32_t azimuth_counts(double azimuth_rad) {
  const double turns = azimuth_rad / (2.0 * std::numbers::pi);
  const auto counts = static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * kFullTurn));
  return counts % kFullTurn;
}

}  // namespace

Vlp16Bytes encode(const Vlp16Packet& packet) {
  using namespace velodyne;
  Vlp16Bytes bytes{};
  for (std::size_t cycle = 0; cycle < Vlp16Packet::kCycles; ++cycle) {
    const std::size_t block = kBlockBytes * (cycle / 2);
    if (cycle % 2 == 0) {
      bytes[block] = kBlockFlag0;
      bytes[block + 1] = kBlockFlag1;
      put_u16(bytes, block + 2, azimuth_counts(packet.azimuth_rad[cycle / 2]));
    }
    for (std::size_t laser = 0; laser < Vlp16Packet::kLasers; ++laser) {
      const LaserReturn& measured = packet.returns[cycle][laser];
      const std::size_t channel = (cycle % 2) * Vlp16Packet::kLasers + laser;
      const std::size_t at = block + kBlockHeaderBytes + kChannelBytes * channel;
      const double counts = std::round(measured.distance_m / velodyne::kVlp16.distance_unit_m);
      if (!(counts >= 1.0 && counts <= 65535.0)) continue;
      put_u16(bytes, at, static_cast<std::uint32_t>(counts));
      bytes[at + 2] = measured.reflectivity;
    }
  }
  put_u16(bytes, kTimestampOffset, packet.timestamp_us & 0xFFFFU);
  put_u16(bytes, kTimestampOffset + 2, packet.timestamp_us >> 16U);
  bytes[kReturnModeOffset] = static_cast<std::uint8_t>(ReturnMode::kStrongest);
  bytes[kProductIdOffset] = static_cast<std::uint8_t>(Model::kVlp16);
  return bytes;
}

}  // namespace isobar::simulation
