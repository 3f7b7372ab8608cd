// SPDX-License-Identifier: BSD-3-Clause
// Data packets of Velodyne: VLP-16 user manual 63-9243, chapter 9; the same layout in 63-9113 (HDL-32E), 63-9318
// (Puck Hi-Res) and 63-9325 (VLP-32C). 12 blocks of a flag, an azimuth and 32 channels; two cycles of 16 lasers
// share a block.
#include <cmath>

#include "simulation/lidar_packet.hpp"

namespace isobar::simulation {

PacketBytes encode_velodyne(const LidarPlan& plan, const LidarPacket& packet) {
  constexpr std::size_t kChannels = 32;
  constexpr double kHourS = 3600.0;
  constexpr std::uint8_t kStrongest = 0x37;
  const std::size_t cycles_per_block = kChannels / plan.lasers;
  PacketBytes bytes;
  bytes.reserve(1'206);
  for (std::size_t cycle = 0; cycle < packet.cycles.size(); ++cycle) {
    const FiringCycle& firing = packet.cycles[cycle];
    if (cycle % cycles_per_block == 0) {
      put_big(bytes, 0xFFEE, 2);
      put_little(bytes, azimuth_counts(firing.azimuth_rad), 2);
    }
    for (std::size_t laser = 0; laser < plan.lasers; ++laser) {
      const LaserReturn& measured = firing.returns[laser];
      const std::uint32_t counts = distance_counts(plan, measured.distance_m);
      put_little(bytes, counts, 2);
      put_little(bytes, counts == 0 ? 0 : measured.reflectivity, 1);
    }
  }
  put_little(bytes, static_cast<std::uint32_t>(std::fmod(packet.sensor_s, kHourS) * 1e6), 4);
  put_little(bytes, kStrongest, 1);
  put_little(bytes, plan.product, 1);
  return bytes;
}

}  // namespace isobar::simulation
