// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace isobar {

/// Directions of a lidar's beams, by channel in the order of the packet.
struct AngleTable {
  std::vector<double> elevation_deg;
  std::vector<double> azimuth_deg;  ///< ahead of the head's, clockwise from above

  [[nodiscard]] std::size_t channels() const { return elevation_deg.size(); }
  /// Rings by channel: the number of channels at a lower elevation; 0 is the lowest.
  [[nodiscard]] std::vector<std::uint8_t> rings() const;
};

/// Why a table cannot be one of this many beams; empty: it can. Rules: as many channels, elevations within
/// -90 … 90 and no two alike, azimuths within -30 … 30.
[[nodiscard]] std::string broken_rule(const AngleTable& table, std::size_t channels);

/// Reads a correction file as the makers give it: lines of `channel,elevation,azimuth` (Hesai, with a header
/// line) or of `elevation,azimuth` (RoboSense), in degrees; empty lines and lines that begin with # are skipped.
/// @throws ConfigError with file, line and rule
[[nodiscard]] AngleTable read_angle_file(const std::string& file, std::size_t channels);

}  // namespace isobar
