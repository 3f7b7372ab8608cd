// SPDX-License-Identifier: BSD-3-Clause
// Readers of recorded data of other projects, the reference for the decoder. The data are not part of this
// project.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::test {

struct RawPacket {
  std::int64_t stamp_ns = 0;
  std::vector<std::uint8_t> bytes;
};

struct TruthPoint {
  float x_m, y_m, z_m;
  std::uint8_t intensity;
  std::uint16_t channel;
  std::uint32_t time_ns;  ///< field time_stamp, unchanged
};

/// All packets of the velodyne_msgs/VelodyneScan messages of a ROS 2 sqlite bag.
std::vector<RawPacket> read_bag_packets(const std::filesystem::path& bag);

/// A binary PCD with the fields x y z intensity return_type channel azimuth elevation distance time_stamp.
std::vector<TruthPoint> read_truth_pcd(const std::filesystem::path& file);

/// All UDP payloads of a classic little-endian Ethernet pcap, by fixed offsets.
std::vector<RawPacket> read_simple_pcap(const std::filesystem::path& file);

}  // namespace isobar::test
