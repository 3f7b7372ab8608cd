// SPDX-License-Identifier: BSD-3-Clause
// Logs of autopilots: PX4's ULog and ArduPilot's dataflash (.BIN), for their IMU and barometer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/recording/tally.hpp"

namespace isobar::imports {

/// Samples of a log, in the order of the file. Axes are x forward, y left, z up: the autopilot's forward, right, down are
/// turned.
struct FlightLog {
  std::string type;  ///< "ULog", "dataflash"
  std::vector<ImuSample> imu;
  std::vector<PressureSample> pressure;
  /// UTC minus the autopilot's clock, by its GNSS receiver; the stamps have it added. Nothing: they count from its start.
  std::optional<std::int64_t> utc_offset_ns;
  recording::Tally damage;
};

/// Whether a file begins as one of them.
[[nodiscard]] bool is_flight_log(const std::filesystem::path& file);

/// Reads the first IMU and the first barometer of a log, as far as it goes.
/// @throws DataError when the file cannot be read or is none of them
[[nodiscard]] FlightLog read_flight_log(const std::filesystem::path& file);

/// Reads a ULog (docs.px4.io, ULog File Format, version 1): sensor_combined, vehicle_air_data or sensor_baro,
/// vehicle_gps_position or sensor_gps.
[[nodiscard]] FlightLog read_ulog(const std::filesystem::path& file);
/// Reads a dataflash log: IMU, BARO, GPS, by the formats that it states itself.
[[nodiscard]] FlightLog read_dataflash(const std::filesystem::path& file);

}  // namespace isobar::imports
