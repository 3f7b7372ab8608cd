// SPDX-License-Identifier: BSD-3-Clause
// From the returns in a packet to points: the one place that is passed by every return of the sensor.
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
  /// Returns nearer than this are dropped [m], 0 … 10: housing and mount of the sensor, 0 keeps all.
  double min_range_m = 0.3;
  /// Returns farther than this are dropped [m], up to 131 (16 bits of 2 mm).
  double max_range_m = 131.0;
  /// Sector in which the sensor sees the robot itself [deg], azimuth clockwise from above as the packet
  /// counts, from start to end, 0 … 360, may pass 0. Equal values: no sector is dropped.
  double mask_start_deg = 0.0;
  double mask_end_deg = 0.0;
};

/// Decodes returns by tables: of what a channel of a block always has (elevation, firing time, share of the
/// rotation, ring), and of all 36 000 azimuths. Without state: equal packets give equal points.
class ReturnDecoder {
 public:
  explicit ReturnDecoder(const VelodyneConfig& config);

  /// Decodes blocks first_block … end_block - 1. `since_start_ns`: time of the packet's first firing after
  /// the scan's start; the first of the blocks must not fire before that start, nor the last 262 ms after it.
  /// `out`: room for kChannels points a block, also for what is dropped.
  /// @return points written
  std::uint32_t decode(const DataPacket& packet, int first_block, int end_block, std::int64_t since_start_ns,
                       ScanPoint* out) const;

 private:
  struct Channel {
    float cos_elevation = 0.0F;
    float sin_elevation = 0.0F;
    std::uint32_t firing_ns = 0;   // after the block's first
    std::uint32_t turn_share = 0;  // of the block's rotation by then, in units of 1 / kWholeShare
    std::uint8_t ring = 0;
  };
  struct Direction {
    float x;
    float y;
  };
  struct Block {
    const std::uint8_t* channels;
    const std::uint8_t* twin;  // channels of the same firing's other return, or nullptr
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
