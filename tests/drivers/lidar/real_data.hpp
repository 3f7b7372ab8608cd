// SPDX-License-Identifier: BSD-3-Clause
// Readers of recorded data of other projects, the reference for the decoders. The data are not part of this
// project.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/samples.hpp"
#include "drivers/lidar/scan_assembler.hpp"

namespace isobar::test {

struct RawPacket {
  std::int64_t stamp_ns = 0;
  std::vector<std::uint8_t> bytes;
};

/// Layout of the scan messages of a bag.
struct BagFormat {
  std::size_t packet_bytes;  ///< of a packet's array
  bool has_size = false;     ///< followed by the number of bytes used
  std::size_t flags = 0;     ///< bytes between a packet's stamp and its array
};
inline constexpr BagFormat kVelodyneBag{1206, false, 0};
inline constexpr BagFormat kHesaiBag{1500, true, 0};
inline constexpr BagFormat kRobosenseBag{1500, true, 1};

struct TruthPoint {
  float x_m, y_m, z_m;
  std::uint8_t intensity;
  std::uint16_t channel;
};

/// All packets of the scan messages of a ROS 2 sqlite bag.
std::vector<RawPacket> read_bag_packets(const std::filesystem::path& bag, const BagFormat& format);

/// A binary or ascii PCD.
std::vector<TruthPoint> read_truth_pcd(const std::filesystem::path& file);

/// All UDP payloads of a classic little-endian Ethernet pcap, by fixed offsets.
std::vector<RawPacket> read_simple_pcap(const std::filesystem::path& file);

struct NearestPoint {
  double apart_m = 1e9;
  ScanPoint point{};
};

/// Nearest of many points, by a 5 cm grid.
class PointGrid {
 public:
  void add(const Scan& scan);
  [[nodiscard]] NearestPoint nearest(const TruthPoint& truth) const;

 private:
  static std::int64_t key(float x, float y, float z, int dx, int dy, int dz);
  std::unordered_map<std::int64_t, std::vector<ScanPoint>> cells_;
};

/// The scans of all packets, the last one included.
std::vector<std::unique_ptr<Scan>> scans_of(ScanAssembler& assembler, const std::vector<RawPacket>& packets);

}  // namespace isobar::test
