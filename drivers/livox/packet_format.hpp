// SPDX-License-Identifier: BSD-3-Clause
// Layout of the packets of a Livox Mid-360: "Livox LiDAR Communication Protocol - Mid360", v1.4.11, chapter 2. All
// integers are little-endian.
//
//   offset  0  version        u8, 0
//           1  length         u16, of the whole payload
//           3  time_interval  u16, 0.1 us, from the first point to the last
//           5  dot_num        u16, points; 1 in an IMU packet
//           7  udp_cnt        u16
//           9  frame_cnt      u8
//          10  data_type      u8
//          11  time_type      u8, source of the time: 0 none, 1 PTP or gPTP, 2 GPS
//          12  reserved       12 bytes
//          24  crc32          u32, over all bytes behind it
//          28  timestamp      u64, ns, of the first point
//          36  data           points at equal intervals of time
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace isobar::livox {

inline constexpr std::size_t kHeaderBytes = 36;
inline constexpr std::size_t kCheckedAt = 28;  ///< first byte of the checksum's range
inline constexpr int kMostPoints = 96;         ///< of a packet
/// Ports of the host, factory setting; the sensor sends from 56300 and 56400.
inline constexpr std::uint16_t kDataPort = 56'301;
inline constexpr std::uint16_t kImuPort = 56'401;

enum class DataType : std::uint8_t {
  kImu = 0,        ///< angular rate (3 f32, rad/s), acceleration (3 f32, g)
  kCartesian = 1,  ///< x, y, z (i32, mm), reflectivity (u8), tag (u8)
  kShort = 2,      ///< x, y, z (i16, cm), reflectivity (u8), tag (u8)
  kSpherical = 3,  ///< not decoded
};

/// Bytes of a sample; 0: unknown.
[[nodiscard]] constexpr std::size_t sample_bytes(std::uint8_t type) {
  constexpr std::size_t kKnown = 4;
  constexpr std::size_t kBytes[kKnown] = {24, 14, 8, 10};  // NOLINT(modernize-avoid-c-arrays)
  return type < kKnown ? kBytes[type] : 0;
}

/// CRC-32 with polynomial 0x04C11DB7, reflected, initial value and final exclusive-or of all ones (chapter 6).
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes);

}  // namespace isobar::livox
