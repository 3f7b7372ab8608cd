// SPDX-License-Identifier: BSD-3-Clause
// From the logs of a sensor and of a reference to the moments that both have measured.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/calibration.hpp"
#include "core/calibration/clock_shift.hpp"
#include "run/recording/pressure_log.hpp"

namespace isobar::tools {

struct LogSelection {
  std::vector<std::filesystem::path> files;
  recording::PressureColumns columns;
};

struct CalibrationLogs {
  LogSelection sensor;     ///< each file is a recording of its own
  LogSelection reference;  ///< all files are one log, unless `paired`
  bool paired = false;     ///< each sensor file belongs to the reference file in the same place
  /// Reference's time minus sensor's [s]; without it the shift is searched.
  std::optional<double> shift_s;
  double window_s = ShiftSearch{}.window_s;
};

struct AlignedLogs {
  std::vector<CalibrationRecording> recordings;
  bool has_temperature = false;
  std::vector<std::string> notes;     ///< what was found out and counted, for the person
  std::vector<std::string> warnings;  ///< what the person should look at
};

/// Reads all logs, finds the shift of their clocks and pairs the samples. Throws DataError: what the logs
/// themselves are refused for, references that overlap, a shift that cannot be told, pressures of different
/// places, a reference that is the sensor.
AlignedLogs align_logs(const CalibrationLogs& logs);

}  // namespace isobar::tools
