// SPDX-License-Identifier: BSD-3-Clause
// Encoder of VLP-16 data packets (VLP-16 user manual 63-9243, chapter 9).
#pragma once

#include <array>
#include <cstdint>

#include "drivers/velodyne/packet_format.hpp"

namespace isobar::simulation {

/// Return of one laser; distance 0: no return.
struct LaserReturn {
  double distance_m = 0.0;
  std::uint8_t reflectivity = 0;
};

/// Content of a packet: 24 firing cycles of 16 lasers, in firing order.
struct Vlp16Packet {
  static constexpr std::size_t kCycles = 24;
  static constexpr std::size_t kLasers = 16;

  /// Azimuth of the first laser of every second cycle [rad], clockwise seen from above, not wrapped.
  std::array<double, kCycles / 2> azimuth_rad{};
  std::array<std::array<LaserReturn, kLasers>, kCycles> returns{};
  std::uint32_t timestamp_us = 0;  ///< sensor clock at the first firing, since the full hour
};

using Vlp16Bytes = std::array<std::uint8_t, velodyne::kDataPacketBytes>;

/// Packet in the mode "strongest return". Distances are rounded to 2 mm; those that do not fit into 16 bits
/// become no return.
[[nodiscard]] Vlp16Bytes encode(const Vlp16Packet& packet);

}  // namespace isobar::simulation
