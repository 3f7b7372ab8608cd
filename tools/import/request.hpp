// SPDX-License-Identifier: BSD-3-Clause
// What a person asks `isobar import` for, and what came of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.hpp"

namespace isobar::tools {

/// Value of a topic's option that leaves a sensor out.
inline constexpr const char* kNoTopic = "none";

/// Members have initialisers, so that callers may name only some.
struct ImportRequest {
  std::filesystem::path source{};
  std::filesystem::path out{};
  // A topic of the source, the file of a log, "none", or empty: found by itself.
  std::string lidar{};
  std::string imu{};
  std::string pressure{};
  std::string base_pressure{};
  std::string wheel{};
  std::string reference{};
  std::vector<std::string> mount_texts{};  ///< "SENSOR=x,y,z,roll,pitch,yaw": m, degrees
  std::string base_frame = "base_link";
  std::string model{};             ///< of the lidar whose packets the source holds; empty: by its packets
  std::string calibration_file{};  ///< of that lidar
  double rate_hz = 0.0;            ///< of scans whose files tell no time; 0: they must tell it
  /// From the lidar's first packet to the first sample of logs without a date [s].
  std::optional<double> log_offset_s{};
  std::string gyro_unit{};      ///< "rad/s", "deg/s"; empty: by its values
  std::string accel_unit{};     ///< "m/s2", "g"; empty: by its values
  std::string pressure_unit{};  ///< "Pa", "hPa", "kPa"; empty: by its values
  /// An IMU that a person would have to be asked about is left out, and said: a lidar alone runs.
  bool asks_nothing = false;
  bool link_files = false;  ///< captures are linked to instead of copied: for a temporary recording

  [[nodiscard]] std::map<std::string, Mount> mounts() const;
};

/// A line of the table of what was found.
struct ImportRow {
  std::string name;  ///< topic or file
  std::string type;
  std::uint64_t count = 0;
  double rate_hz = 0.0;  ///< 0: unknown
  std::string becomes;   ///< the file it becomes and its units, or why it becomes none
};

struct ImportReport {
  std::string container;
  std::vector<ImportRow> rows;
  std::vector<std::string> notes;
};

/// The table as text, a line an element.
[[nodiscard]] std::vector<std::string> table_of(const ImportReport& report);

}  // namespace isobar::tools
