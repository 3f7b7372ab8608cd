// SPDX-License-Identifier: BSD-3-Clause
// Layout of a data packet of the Hesai XT family: XT16 and XT32 user manuals, "Point cloud data packet".
// All integers are little-endian.
//
//   pre-header  EE FF, protocol 06 01, 2 reserved
//   header      lasers u8, blocks u8 (8), first block return u8, distance unit u8 [mm], returns u8, flags u8
//   8 blocks    azimuth u16 [0.01 deg], then by laser: distance u16, reflectivity u8, reserved u8
//   tail        10 reserved, return mode u8, motor speed u16, date and time 6 x u8 (year - 1900), microsecond
//               u32, factory u8
//   sequence    u32, if bit 0 of the flags is set
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace isobar::hesai {

inline constexpr std::size_t kHeaderBytes = 12;
inline constexpr int kBlocks = 8;
inline constexpr std::size_t kAzimuthBytes = 2;
inline constexpr std::size_t kReturnBytes = 4;
inline constexpr std::size_t kTailBytes = 24;
inline constexpr std::size_t kSequenceBytes = 4;
inline constexpr std::size_t kGpsPacketBytes = 512;
// In the header.
inline constexpr std::size_t kLasersOffset = 6;
inline constexpr std::size_t kBlocksOffset = 7;
inline constexpr std::size_t kUnitOffset = 9;
inline constexpr std::size_t kFlagsOffset = 11;
// In the tail.
inline constexpr std::size_t kReturnModeOffset = 10;
inline constexpr std::size_t kDateOffset = 13;
inline constexpr std::size_t kMicrosecondOffset = 19;

/// Geometry and firing times of a model ("Laser firing time" of the manuals).
struct ModelTraits {
  std::string_view name;        ///< in recordings and configurations
  int lasers;                   ///< 16 or 32
  std::int64_t firing_step_ns;  ///< from one laser to the next
  double highest_deg;           ///< elevation of channel 1, the highest beam
  double elevation_step_deg;    ///< from a channel to the next, downward

  [[nodiscard]] constexpr std::size_t block_bytes() const {
    return kAzimuthBytes + static_cast<std::size_t>(lasers) * kReturnBytes;
  }
  /// Without a sequence number.
  [[nodiscard]] constexpr std::size_t packet_bytes() const {
    return kHeaderBytes + kBlocks * block_bytes() + kTailBytes;
  }
};

inline constexpr std::int64_t kBlockNs = 50'000;     ///< from one firing of all lasers to the next
inline constexpr std::int64_t kLastBlockNs = 5'632;  ///< the last firing after the packet's time
inline constexpr std::int64_t kFirstLaserNs = 368;   ///< the first laser after its firing's beginning

inline constexpr ModelTraits kXt16{"XT16", 16, 3'024, 15.0, 2.0};
inline constexpr ModelTraits kXt32{"XT32", 32, 1'512, 15.0, 1.0};

}  // namespace isobar::hesai
