// SPDX-License-Identifier: BSD-3-Clause
// Conversion of the returns in a packet to points: the inner loop of the lidar driver.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/samples.hpp"
#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/packet_format.hpp"

namespace isobar::velodyne {

struct VelodyneConfig {
  Model model = Model::kVlp16;
  /// Nearer returns are dropped [m], 0 … 10: they come from the sensor's housing and mount. 0 keeps all.
  double min_range_m = 0.3;
  /// Farther returns are dropped [m], up to 131 (16 bits of 2 mm).
  double max_range_m = 131.0;
  /// Masked sector, in which the sensor sees the robot itself [deg], 0 … 360: from start clockwise (seen from
  /// above, as the packet's azimuth) to end, across 0 if end < start. Equal values mask nothing.
  double mask_start_deg = 0.0;
  double mask_end_deg = 0.0;
};

/// Table-driven decoder: one table by channel (elevation, firing time, share of the block's rotation, ring),
/// one by azimuth (all 36 000). Stateless: equal packets give equal points.
class ReturnDecoder {
 public:
  explicit ReturnDecoder(const VelodyneConfig& config);

  /// Changes the range and the masked sector, not the model. Allocates nothing.
  void set_limits(const VelodyneConfig& config);

  /// Decodes blocks first_block … end_block - 1.
  /// @param since_start_ns time of the packet's first firing after the scan's start; all blocks decoded must
  ///         fire 0 … 262 ms after that start
  /// @param out room for kChannels points a block, dropped returns included
  /// @return points written
  std::uint32_t decode(const DataPacket& packet, int first_block, int end_block, std::int64_t since_start_ns,
                       ScanPoint* out) const;

 private:
  struct Channel {
    float cos_elevation = 0.0F;
    float sin_elevation = 0.0F;
    std::uint32_t firing_ns = 0;   // after the block's first firing
    std::uint32_t turn_share = 0;  // share of the block's rotation at that time, in units of 1 / kWholeShare
    std::uint8_t ring = 0;
  };
  struct Direction {
    float x;
    float y;
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
  std::vector<Direction> directions_;  // by azimuth [0.01 deg]; y is to the left, azimuth clockwise
  std::uint32_t min_count_ = 1;        // in units of kDistanceUnitM
  std::uint32_t max_count_ = 0;
  std::uint32_t mask_start_ = 0;
  std::uint32_t mask_width_ = 0;
};

}  // namespace isobar::velodyne
