// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_packet.hpp"

#include <cmath>
#include <numbers>

namespace isobar::simulation {

PacketBytes encode(const LidarPlan& plan, const LidarPacket& packet) {
  switch (plan.maker) {
    case LidarMaker::kVelodyne:
      return encode_velodyne(plan, packet);
    case LidarMaker::kHesai:
      return encode_hesai(plan, packet);
    case LidarMaker::kRobosense:
      return encode_robosense(plan, packet);
    case LidarMaker::kOuster:
      return encode_ouster(plan, packet);
    case LidarMaker::kLivox:
      return encode_livox(plan, packet);
  }
  return {};
}

void put_little(PacketBytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i, value >>= 8U) bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}

void put_big(PacketBytes& bytes, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) {
    bytes.push_back(static_cast<std::uint8_t>((value >> (8U * static_cast<unsigned>(i))) & 0xFFU));
  }
}

std::uint32_t azimuth_counts(double azimuth_rad) {
  constexpr std::uint32_t kTurn = 36'000;
  const double turns = azimuth_rad / (2.0 * std::numbers::pi);
  const auto counts = static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * kTurn));
  return counts % kTurn;
}

std::uint32_t distance_counts(const LidarPlan& plan, double distance_m) {
  const double counts = std::round(distance_m / plan.distance_unit_m);
  return counts >= 1.0 && counts <= 65'535.0 ? static_cast<std::uint32_t>(counts) : 0;
}

}  // namespace isobar::simulation
