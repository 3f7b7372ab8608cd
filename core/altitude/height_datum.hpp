// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Height datum: what ties a height to the pressure of the air, so that a later run continues it.
///
///   height of the IMU = scale ln(reference / pressure) - lever of the port - offset_m
///
/// where ln(reference) = ln(pressure of the base station) + station_offset_log.
struct HeightDatum {
  static constexpr std::size_t kStations = 2;

  bool known = false;         ///< a barometer has given heights
  std::int64_t stamp_ns = 0;  ///< time of height_m, robot clock
  double height_m = 0.0;      ///< of base_link, as Prior::height_m
  double climb_m_s = 0.0;     ///< vertical speed at that time
  double variance_m2 = 0.0;   ///< of height_m
  double offset_m = 0.0;      ///< bias of the barometers, in metres of height
  bool ground_moves = false;  ///< the robot stands in an elevator that rides
  bool step_open = false;     ///< the pressure is disturbed: its heights do not belong to the datum
  std::array<bool, kStations> station_known{};
  std::array<double, kStations> station_offset_log{};
};

}  // namespace isobar
