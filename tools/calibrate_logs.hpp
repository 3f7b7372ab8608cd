// SPDX-License-Identifier: BSD-3-Clause
// Reads the logs of a sensor and of a reference, aligns their clocks and pairs their samples.
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
  LogSelection reference;  ///< together one log, unless `paired`
  bool paired = false;     ///< the n-th sensor file belongs to the n-th reference file
  /// Reference clock minus sensor clock [s]; without it, the shift is searched within ± window_s.
  std::optional<double> shift_s;
  double window_s = ShiftSearch{}.window_s;
};

struct AlignedLogs {
  std::vector<CalibrationRecording> recordings;
  bool has_temperature = false;
  std::vector<std::string> notes;     ///< detected columns, units and shifts, rows left out
  std::vector<std::string> warnings;  ///< for the user to check
};

/// Reads all logs, finds the shift of their clocks and pairs the samples.
/// @throws DataError when a log cannot be read, references overlap, the shift is ambiguous, the pressures are
/// of different places, or the reference is the sensor itself
/// @throws UsageError when `paired` logs differ in number
AlignedLogs align_logs(const CalibrationLogs& logs);

}  // namespace isobar::tools
