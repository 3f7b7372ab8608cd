// SPDX-License-Identifier: BSD-3-Clause
// Layout of a Velodyne data packet: VLP-16 user manual 63-9243 chapter 9, HDL-32E user manual 63-9113
// appendix, VLP-32C user manual 63-9325 chapter 9. All integers are little-endian.
//
//   12 data blocks of 100 bytes each:
//     flag FF EE
//     azimuth       u16, 0.01 deg
//     32 channels   of distance (u16, 2 mm; VLP-32C: 4 mm) and reflectivity (u8)
//   timestamp       u32, microseconds past the hour, of the first firing in the packet
//   return mode     u8
//   product id      u8
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/lidar/lidar_decoder.hpp"

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

inline constexpr std::int64_t kClockPeriodNs = 3'600'000'000'000;  ///< the timestamp wraps at the hour
inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;

enum class ReturnMode : std::uint8_t { kStrongest = 0x37, kLast = 0x38, kDual = 0x39 };
/// The product id in the last byte of a data packet.
enum class Model : std::uint8_t { kHdl32e = 0x21, kVlp16 = 0x22, kVlp16HiRes = 0x24, kVlp32c = 0x28 };

/// Geometry and firing times of a model.
struct ModelTraits {
  Model model;
  std::string_view name;                 ///< in recordings and configurations
  int lasers;                            ///< 16 or 32
  int firings_per_block;                 ///< firing cycles that share one azimuth
  std::int64_t firing_cycle_ns;          ///< period of a laser: all lasers once, and the recharge time
  std::int64_t firing_step_ns;           ///< from one group of lasers to the next
  int lasers_at_once;                    ///< lasers of a group, which fire together
  double distance_unit_m;                ///< of the packet's distances
  std::array<double, 32> elevation_deg;  ///< by laser, in firing order
  /// By laser, in firing order: azimuth of its beam ahead of the head's [0.01 deg].
  std::array<int, 32> azimuth_ahead{};
  std::array<std::uint8_t, 32> ring{};  ///< by laser; 0 is the lowest

  /// Time covered by one packet [ns]. In dual return two blocks hold the same firing.
  [[nodiscard]] constexpr std::int64_t packet_duration_ns(bool dual) const {
    return std::int64_t{dual ? kBlocks / 2 : kBlocks} * firings_per_block * firing_cycle_ns;
  }
  /// Firing time after the packet's timestamp [ns]. block: 0 … 11; channel: 0 … 31.
  [[nodiscard]] constexpr std::int64_t firing_offset_ns(int block, int channel, bool dual) const {
    const int turn = (dual ? block / 2 : block) * firings_per_block + channel / lasers;
    return turn * firing_cycle_ns + (channel % lasers) / lasers_at_once * firing_step_ns;
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
    detail::with_rings({.model = Model::kVlp16,
                        .name = "VLP-16",
                        .lasers = 16,
                        .firings_per_block = 2,
                        .firing_cycle_ns = 55'296,
                        .firing_step_ns = 2'304,
                        .lasers_at_once = 1,
                        .distance_unit_m = 0.002,
                        .elevation_deg = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15}});

/// VLP-16 Hi-Res, "Puck Hi-Res": 63-9318.
inline constexpr ModelTraits kVlp16HiRes =
    detail::with_rings({.model = Model::kVlp16HiRes,
                        .name = "VLP-16 Hi-Res",
                        .lasers = 16,
                        .firings_per_block = 2,
                        .firing_cycle_ns = 55'296,
                        .firing_step_ns = 2'304,
                        .lasers_at_once = 1,
                        .distance_unit_m = 0.002,
                        .elevation_deg = {-10.00, 0.67, -8.67, 2.00, -7.33, 3.33, -6.00, 4.67, -4.67, 6.00,
                                          -3.33, 7.33, -2.00, 8.67, -0.67, 10.00}});

inline constexpr ModelTraits kHdl32e = detail::with_rings(
    {.model = Model::kHdl32e,
     .name = "HDL-32E",
     .lasers = 32,
     .firings_per_block = 1,
     .firing_cycle_ns = 46'080,
     .firing_step_ns = 1'152,
     .lasers_at_once = 1,
     .distance_unit_m = 0.002,
     .elevation_deg = {-30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
                       -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
                       -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67}});

/// VLP-32C: two lasers fire at once; beams lie beside the head's azimuth (63-9325, table of elevation angles
/// and azimuth offsets).
inline constexpr ModelTraits kVlp32c =
    detail::with_rings({.model = Model::kVlp32c,
                        .name = "VLP-32C",
                        .lasers = 32,
                        .firings_per_block = 1,
                        .firing_cycle_ns = 55'296,
                        .firing_step_ns = 2'304,
                        .lasers_at_once = 2,
                        .distance_unit_m = 0.004,
                        .elevation_deg = {-25.0,  -1.0,  -1.667, -15.639, -11.31, 0.0,   -0.667, -8.843,
                                          -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4.0,
                                          -4.667, 1.667, 1.0,    -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                          -3.0,   7.0,   4.667,  -2.333,  -2.0,   15.0,  10.333, -1.333},
                        .azimuth_ahead = {140,  -420, 140,  -140, 140,  -140, 420,  -140, 140,  -420, 140,
                                          -140, 420,  -140, 420,  -140, 140,  -420, 140,  -420, 420,  -140,
                                          140,  -140, 140,  -140, 140,  -420, 420,  -140, 140,  -140}});

inline constexpr std::array<const ModelTraits*, 4> kModels{&kVlp16, &kVlp16HiRes, &kHdl32e, &kVlp32c};

/// Traits of a model.
[[nodiscard]] constexpr const ModelTraits& traits_of(Model model) {
  for (const ModelTraits* traits : kModels) {
    if (traits->model == model) return *traits;
  }
  return kVlp16;
}
/// Traits of a model by its name, "VLP-16"; nullptr for any other.
[[nodiscard]] constexpr const ModelTraits* find_model(std::string_view name) {
  for (const ModelTraits* traits : kModels) {
    if (traits->name == name) return traits;
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
      return "VLP-16 Hi-Res";
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
