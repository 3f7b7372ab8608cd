// SPDX-License-Identifier: BSD-3-Clause
// Bytes of a VLP-16 data packet, as the sensor sends them (VLP-16 user manual 63-9243, chapter 9).
#pragma once

#include <array>
#include <cstdint>

#include "drivers/velodyne/packet_format.hpp"

namespace isobar::simulation {

/// One return; distance 0 means none.
struct LaserReturn {
  double distance_m = 0.0;
  std::uint8_t reflectivity = 0;
};

/// What one packet holds: 24 firing cycles of 16 lasers, in firing order.
struct Vlp16Packet {
  static constexpr std::size_t kCycles = 24;
  static constexpr std::size_t kLasers = 16;

  /// Azimuth of the first laser of every second cycle [rad, clockwise from above, any turn].
  std::array<double, kCycles / 2> azimuth_rad{};
  std::array<std::array<LaserReturn, kLasers>, kCycles> returns{};
  std::uint32_t timestamp_us = 0;  ///< sensor clock at the first firing, past the hour
};

using Vlp16Bytes = std::array<std::uint8_t, velodyne::kDataPacketBytes>;

/// Single return, strongest. Distances are rounded to 2 mm; what does not fit 16 bits counts as no return.
[[nodiscard]] Vlp16Bytes encode(const Vlp16Packet& packet);

}  // namespace isobar::simulation
