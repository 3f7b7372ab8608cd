// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "drivers/velodyne/data_packet.hpp"

namespace isobar::velodyne {

/// Evidence of a 16-laser model in the packets themselves: early VLP-16s send the product id of an HDL-32E.
///
/// Firing pattern: a block holds two firings of 16 lasers, so channels c and c + 16 are the same beam 55 us
/// apart and see nearly the same range; channels c and c + 15 are not. Pace: 24 firings of 55.3 us in a packet,
/// where an HDL-32E needs 12 of 46.1 us. One of the two suffices: ranges are missing under open sky, and
/// packets may be lost.
class ModelEvidence {
 public:
  void add(const DataPacket& packet);
  /// Whether the packets so far are those of 16 lasers.
  [[nodiscard]] bool has_sixteen_lasers() const { return sixteen_; }

 private:
  void add_pattern(const DataPacket& packet);
  void add_pace(const DataPacket& packet);

  std::uint32_t pairs_ = 0;
  std::uint32_t same_beam_ = 0;   // pairs (c, c + 16) of nearly the same range
  std::uint32_t other_beam_ = 0;  // pairs (c, c + 15) of nearly the same range
  std::uint32_t gaps_ = 0;
  std::uint32_t shortest_us_ = 0;
  std::uint32_t last_us_ = 0;
  bool started_ = false;
  bool sixteen_ = false;
};

}  // namespace isobar::velodyne
