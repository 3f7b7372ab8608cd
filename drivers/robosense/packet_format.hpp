// SPDX-License-Identifier: BSD-3-Clause
// Layout of the packets of RoboSense's mechanical lidars: RS-LiDAR-16 and RS-Helios user manuals, "MSOP" and
// "DIFOP". All integers are big-endian.
//
//   MSOP, 1248 bytes
//     header    42 bytes: id (RS-16: 8 bytes, Helios: 4), at 20 the time (10 bytes), at 30 the lidar's type
//     12 blocks FF EE, azimuth u16 [0.01 deg], 32 channels of distance u16 and intensity u8
//     tail      6 bytes
//   DIFOP, 1248 bytes
//     id        A5 FF 00 5A 11 11 55 55
//     at 8      turns a minute u16; at 300 the return mode; at 301, 302 synchronisation mode and state (Helios)
//     Helios:   at 468 32 elevations, at 564 32 azimuths: sign u8 (1: negative), u16 [0.01 deg]
//     RS-16:    at 1165 16 elevations, u24 [0.0001 deg], those of channels 1 to 8 negative
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace isobar::robosense {

inline constexpr std::size_t kPacketBytes = 1248;
inline constexpr std::size_t kHeaderBytes = 42;
inline constexpr std::size_t kTimeOffset = 20;
inline constexpr int kBlocks = 12;
inline constexpr int kChannels = 32;  ///< per block
inline constexpr std::size_t kBlockBytes = 100;
inline constexpr std::size_t kBlockHeaderBytes = 4;
inline constexpr std::size_t kChannelBytes = 3;
inline constexpr std::array<std::uint8_t, 8> kDifopId{0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
inline constexpr std::size_t kReturnModeOffset = 300;
inline constexpr std::size_t kSyncStateOffset = 302;

/// Form of the time in an MSOP header.
enum class TimeForm : std::uint8_t {
  kDate,  ///< year - 2000, month, day, hour, minute, second: u8 each; millisecond, microsecond: u16 each
  kSinceEpoch,  ///< second u48, microsecond u32
};

/// Form of the angles in a DIFOP packet.
enum class AngleForm : std::uint8_t { kRs16, kHelios };

/// Geometry and firing times of a model.
struct ModelTraits {
  std::string_view name;  ///< in recordings and configurations
  int lasers;             ///< 16, which fire twice in a block, or 32
  std::array<std::uint8_t, 8> id;
  std::size_t id_bytes;
  TimeForm time_form;
  AngleForm angle_form;
  double distance_unit_m;
  /// Radius on which the optical centre turns [m]: the beam begins there, in the direction of the block's azimuth.
  double centre_radius_m;
  std::int64_t cycle_ns;                 ///< all lasers once
  std::array<std::int32_t, 32> fire_ns;  ///< by laser, within a cycle
  std::array<double, 32> elevation_deg;  ///< nominal, by laser
  std::array<double, 32> azimuth_deg;    ///< nominal, by laser
};

inline constexpr ModelTraits kRs16{
    .name = "RS-LiDAR-16",
    .lasers = 16,
    .id = {0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0},
    .id_bytes = 8,
    .time_form = TimeForm::kDate,
    .angle_form = AngleForm::kRs16,
    .distance_unit_m = 0.005,
    .centre_radius_m = 0.03825,
    .cycle_ns = 55'500,
    .fire_ns = {0, 2'800, 5'600, 8'400, 11'200, 14'000, 16'800, 19'600, 22'400, 25'200, 28'000, 30'800,
                33'600, 36'400, 39'200, 42'000},
    .elevation_deg = {-15, -13, -11, -9, -7, -5, -3, -1, 15, 13, 11, 9, 7, 5, 3, 1},
    .azimuth_deg = {}};

/// Lasers 1 to 16 of the Helios family.
inline constexpr ModelTraits kHelios16p{
    .name = "Helios-16P",
    .lasers = 16,
    .id = {0x55, 0xAA, 0x05, 0x5A},
    .id_bytes = 4,
    .time_form = TimeForm::kSinceEpoch,
    .angle_form = AngleForm::kHelios,
    .distance_unit_m = 0.0025,
    .centre_radius_m = 0.03498,
    .cycle_ns = 55'560,
    .fire_ns = {0, 3'150, 6'300, 9'450, 13'260, 17'080, 20'560, 23'710, 26'530, 27'770, 31'490, 32'730,
                36'460, 38'940, 41'420, 43'910},
    .elevation_deg = {15.0, 13.0, 11.0, 9.0, 7.0, 5.5, 4.0, 2.67, 1.33, 0.0, -1.33, -2.67, -4.0, -5.33, -6.67,
                      -8.0},
    .azimuth_deg = {-4.0, 3.6, -4.0, 3.6, -4.0, 3.6, -4.0, 3.6, -4.0, 3.6, -4.0, 3.6, -4.0, 3.6, -4.0, 3.6}};

}  // namespace isobar::robosense
