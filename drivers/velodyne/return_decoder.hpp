// SPDX-License-Identifier: BSD-3-Clause
// Conversion of the returns in a packet to points: the inner loop of the lidar driver.
#pragma once

#include <array>
#include <cstdint>

#include "core/samples.hpp"
#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/lidar/turn_directions.hpp"
#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/packet_format.hpp"

namespace isobar::velodyne {

/// Table-driven decoder: one table by channel (elevation, firing time, share of the block's rotation, ring),
/// one by azimuth (all 36 000). Stateless: equal packets give equal points.
class ReturnDecoder {
 public:
  explicit ReturnDecoder(const ModelTraits& traits);

  /// Changes the range and the masked sector. Allocates nothing.
  void set_limits(const LidarLimits& limits);

  /// Decodes blocks first_block … end_block - 1.
  /// @param since_start_ns time of the packet's first firing after the scan's start; all blocks decoded must
  ///         fire 0 … 262 ms after that start
  /// @param columns firing times and azimuths of the blocks
  /// @param out room for kChannels points a block, dropped returns included
  /// @return points written
  std::uint32_t decode(const DataPacket& packet, const PacketColumns& columns, int first_block, int end_block,
                       std::int64_t since_start_ns, ScanPoint* out) const;

 private:
  struct Channel {
    float cos_elevation = 0.0F;
    float sin_elevation = 0.0F;
    std::uint32_t firing_ns = 0;   // after the block's first firing
    std::uint32_t turn_share = 0;  // share of the block's rotation at that time, in units of 1 / kWholeShare
    std::uint32_t ahead = 0;       // azimuth ahead of the head's, 0 … kFullTurn - 1
    std::uint8_t ring = 0;
  };
  struct Block {
    const std::uint8_t* channels;
    const std::uint8_t* other_return;  // channels of the same firing's other return, or nullptr
    std::uint32_t azimuth;
    std::uint32_t step;      // rotation until the next block [0.01 deg]
    std::uint32_t start_ns;  // after the scan's start
  };

  std::uint32_t decode_block(const Block& block, ScanPoint* out) const;

  const ModelTraits& traits_;
  std::array<Channel, kChannels> channels_{};
  const std::vector<TurnDirection>& directions_;
  CountLimits limits_;
};

}  // namespace isobar::velodyne
