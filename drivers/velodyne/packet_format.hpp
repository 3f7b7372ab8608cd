// SPDX-License-Identifier: BSD-3-Clause
// Layout of a Velodyne data packet: VLP-16 user manual 63-9243 chapter 9, HDL-32E user manual 63-9113
// appendix. All integers are little-endian.
//
//   12 data blocks of 100 bytes each:
//     flag FF EE
//     azimuth       u16, 0.01 deg
//     32 channels   of distance (u16, 2 mm) and reflectivity (u8)
//   timestamp       u32, microseconds past the hour, of the first firing in the packet
//   return mode     u8
//   product id      u8
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace isobar::velodyne {

inline constexpr std::size_t kDataPacketBytes = 1206;
inline constexpr std::size_t kPositionPacketBytes = 512;
inline constexpr int kBlocks = 12;
inline constexpr int kChannels = 32;  ///< per block
inline constexpr std::size_t kBlockBytes = 100;
inline constexpr std::size_t kBlockHeaderBytes = 4;
inline constexpr std::size_t kChannelBytes = 3;
inline constexpr std::uint8_t kBlockFlag0 = 0xFF;
inline constexpr std::uint8_t kBlockFlag1 = 0xEE;
inline constexpr std::size_t kTimestampOffset = 1200;
inline constexpr std::size_t kReturnModeOffset = 1204;
inline constexpr std::size_t kProductIdOffset = 1205;

inline constexpr double kDistanceUnitM = 0.002;
inline constexpr std::uint32_t kFullTurn = 36'000;                 ///< counts of a turn [0.01 deg]
inline constexpr std::int64_t kClockPeriodNs = 3'600'000'000'000;  ///< the timestamp wraps at the hour
inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;

enum class ReturnMode : std::uint8_t { kStrongest = 0x37, kLast = 0x38, kDual = 0x39 };
/// The product id in the last byte of a data packet.
enum class Model : std::uint8_t { kHdl32e = 0x21, kVlp16 = 0x22 };

/// Geometry and firing times of a model.
struct ModelTraits {
  Model model;
  std::string_view name;                 ///< in recordings and configurations
  int lasers;                            ///< 16 or 32
  int firings_per_block;                 ///< firing cycles that share one azimuth
  std::int64_t firing_cycle_ns;          ///< period of a laser: all lasers once, and the recharge time
  std::int64_t firing_step_ns;           ///< from one laser to the next
  double max_range_m;                    ///< data sheet
  std::array<double, 32> elevation_deg;  ///< by laser, in firing order
  std::array<std::uint8_t, 32> ring;     ///< by laser; 0 is the lowest

  /// Time covered by one packet [ns]. In dual return two blocks hold the same firing.
  [[nodiscard]] constexpr std::int64_t packet_duration_ns(bool dual) const {
    return std::int64_t{dual ? kBlocks / 2 : kBlocks} * firings_per_block * firing_cycle_ns;
  }
  /// Firing time after the packet's timestamp [ns]. block: 0 … 11; channel: 0 … 31.
  [[nodiscard]] constexpr std::int64_t firing_offset_ns(int block, int channel, bool dual) const {
    const int turn = (dual ? block / 2 : block) * firings_per_block + channel / lasers;
    return turn * firing_cycle_ns + (channel % lasers) * firing_step_ns;
  }
};

namespace detail {
/// Fills the rings: the number of lasers at a lower elevation.
constexpr ModelTraits with_rings(ModelTraits traits) {
  for (int laser = 0; laser < traits.lasers; ++laser) {
    std::uint8_t below = 0;
    for (int other = 0; other < traits.lasers; ++other) {
      below += traits.elevation_deg[static_cast<std::size_t>(other)] <
                       traits.elevation_deg[static_cast<std::size_t>(laser)]
                   ? 1
                   : 0;
    }
    traits.ring[static_cast<std::size_t>(laser)] = below;
  }
  return traits;
}
}  // namespace detail

inline constexpr ModelTraits kVlp16 =
    detail::with_rings({Model::kVlp16,
                        "VLP-16",
                        16,
                        2,
                        55'296,
                        2'304,
                        100.0,
                        {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15},
                        {}});

inline constexpr ModelTraits kHdl32e = detail::with_rings(
    {Model::kHdl32e,
     "HDL-32E",
     32,
     1,
     46'080,
     1'152,
     100.0,
     {-30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
      -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
      -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67},
     {}});

/// Traits of a model.
[[nodiscard]] constexpr const ModelTraits& traits_of(Model model) {
  return model == Model::kVlp16 ? kVlp16 : kHdl32e;
}
/// Traits of a model by its name ("VLP-16", "HDL-32E"); nullptr for any other.
[[nodiscard]] constexpr const ModelTraits* find_model(std::string_view name) {
  for (const ModelTraits* traits : {&kVlp16, &kHdl32e}) {
    if (traits->name == name) {
      return traits;
    }
  }
  return nullptr;
}
/// Name of a product id, including models that are not decoded.
[[nodiscard]] constexpr std::string_view product_name(std::uint8_t product_id) {
  switch (product_id) {
    case 0x21:
      return "HDL-32E";
    case 0x22:
      return "VLP-16";
    case 0x24:
      return "Puck Hi-Res";
    case 0x28:
      return "VLP-32C";
    case 0x31:
      return "Velarray";
    case 0xA1:
      return "VLS-128";
    default:
      return "unknown model";
  }
}

}  // namespace isobar::velodyne
