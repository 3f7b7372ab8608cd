// SPDX-License-Identifier: BSD-3-Clause
// Layout of an Ouster lidar packet: Ouster sensor documentation, "Sensor Data", "Lidar Data Packet Format". All
// integers are little-endian.
//
//   packet header   32 bytes; none in the LEGACY profile
//   columns         of one encoder position each:
//     timestamp       u64, ns
//     measurement id  u16, position in the turn
//     status          u16, bit 0: the column holds data
//                     LEGACY: u16 frame id and u32 encoder count here, u32 status of all ones behind the pixels
//     pixels          from the highest beam to the lowest; layout by profile
//   packet footer   32 bytes; none in the LEGACY profile
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "drivers/lidar/lidar_decoder.hpp"

namespace isobar::ouster {

inline constexpr std::uint16_t kDataPort = 7502;
inline constexpr std::uint16_t kImuPort = 7503;
inline constexpr int kMostPixels = 256;
inline constexpr int kMostColumnsPerTurn = 8'192;

/// Layout of a pixel: setting udp_profile_lidar of the sensor. Returns of a pixel are kReturnBytes apart.
struct Profile {
  std::string_view name;
  std::size_t pixel_bytes;
  int returns;                      ///< 1, or 2: the stronger first
  std::uint32_t range_mask;         ///< of the first 32 bits of a return
  double range_unit_m;              ///< of the range
  std::size_t reflectivity_offset;  ///< in the return
  bool wide_reflectivity = false;   ///< 16 bits: firmware before 2.1; above 255 is 255
  bool has_header = true;           ///< packet header and footer
  bool has_safety_header = false;   ///< packet header of the functional safety firmware, where not told
  static constexpr std::size_t kReturnBytes = 4;
};

inline constexpr std::uint32_t kRange20 = 0xF'FFFF;
inline constexpr std::uint32_t kRange19 = 0x7'FFFF;
inline constexpr std::uint32_t kRange15 = 0x7FFF;

inline constexpr std::array kProfiles{
    Profile{"LEGACY", 12, 1, kRange20, 0.001, 4, true, false},
    Profile{"RNG19_RFL8_SIG16_NIR16", 12, 1, kRange19, 0.001, 4},
    Profile{"RNG19_RFL8_SIG16_NIR16_DUAL", 16, 2, kRange19, 0.001, 3},
    Profile{"RNG15_RFL8_NIR8", 4, 1, kRange15, 0.008, 2},
    Profile{"RNG15_RFL8_NIR8_DUAL", 8, 2, kRange15, 0.008, 2},
    Profile{"FUSA_RNG15_RFL8_NIR8_DUAL", 8, 2, kRange15, 0.008, 2, false, true, true},
    Profile{"RNG15_RFL8_WIN8", 4, 1, kRange15, 0.008, 2},
    Profile{"RNG15_RFL8_NIR8_ZONE16", 8, 1, kRange15, 0.008, 2},
    Profile{"RNG19_RFL8_SIG16_NIR16_ZONE16", 12, 1, kRange19, 0.001, 4},
};

/// Names of all profiles, for messages.
[[nodiscard]] std::string profile_names();

/// Identity of the sensor in a packet header; all 0 in the LEGACY profile.
struct PacketHeader {
  std::uint32_t type = 0;     ///< 1: lidar data
  std::uint32_t init_id = 0;  ///< initialisation id, differs from start to start of a sensor
  std::uint64_t serial = 0;
};

/// Byte positions in packets of one sensor.
class PacketLayout {
 public:
  static constexpr std::size_t kHeaderBytes = 32;
  static constexpr std::size_t kFooterBytes = 32;

  PacketLayout(const Profile& profile, int pixels, int columns, bool has_safety_header)
      : profile_(&profile),
        pixels_(static_cast<std::size_t>(pixels)),
        columns_(static_cast<std::size_t>(columns)),
        has_safety_header_(has_safety_header) {}

  [[nodiscard]] const Profile& profile() const { return *profile_; }
  [[nodiscard]] std::size_t pixels() const { return pixels_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t column_header_bytes() const { return profile_->has_header ? 12 : 16; }
  [[nodiscard]] std::size_t column_bytes() const {
    return column_header_bytes() + pixels_ * profile_->pixel_bytes + (profile_->has_header ? 0 : 4);
  }
  [[nodiscard]] std::size_t packet_bytes() const {
    return columns_ * column_bytes() + (profile_->has_header ? kHeaderBytes + kFooterBytes : 0);
  }
  [[nodiscard]] const std::uint8_t* column(const std::uint8_t* packet, std::size_t index) const {
    return packet + (profile_->has_header ? kHeaderBytes : 0) + index * column_bytes();
  }
  [[nodiscard]] const std::uint8_t* pixels_of(const std::uint8_t* column) const {
    return column + column_header_bytes();
  }
  [[nodiscard]] bool is_valid(const std::uint8_t* column) const {
    return profile_->has_header ? (column[10] & 1U) != 0 : le32(column + column_bytes() - 4) == 0xFFFF'FFFF;
  }
  [[nodiscard]] static std::uint64_t timestamp_ns(const std::uint8_t* column) { return le64(column); }
  [[nodiscard]] static std::uint32_t measurement_id(const std::uint8_t* column) { return le16(column + 8); }
  [[nodiscard]] PacketHeader header(const std::uint8_t* packet) const;

 private:
  const Profile* profile_;
  std::size_t pixels_;
  std::size_t columns_;
  bool has_safety_header_;
};

/// The formats of packets of a size, for messages: "128 beams in RNG15_RFL8_NIR8, or …"; empty: none is known.
[[nodiscard]] std::string formats_of_size(std::size_t bytes);

}  // namespace isobar::ouster
