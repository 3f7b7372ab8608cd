// SPDX-License-Identifier: BSD-3-Clause
// Pressure from any logger's CSV; columns and units, also the unit of time, are detected and reported.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/samples.hpp"

namespace isobar::recording {

/// Columns by name; an empty name is detected from the header.
struct PressureColumns {
  std::string time;
  std::string pressure;
  std::string temperature;
  std::string pressure_unit;     ///< see unit_of_word()
  std::string temperature_unit;  ///< C, K, F
  std::string time_unit;         ///< ns, us, ms, s, min, h
  bool needs_temperature = true;
};

struct PressureLog {
  std::string file;
  std::vector<PressureSample> samples;  ///< ascending in time; temperature_c NaN where there is none
  bool has_temperature = false;         ///< the file has a column for it
  std::vector<std::string> notes;       ///< detected columns and units; refused rows, counted
};

/// Reads one file. Separators: comma, semicolon or tab; with the latter two, decimals may have a comma. Other lines may
/// precede the header, and lines of units follow it. Time is one column, a date and a time, or seconds and nanoseconds;
/// see row_times.hpp for whole seconds and for a clock that is set back. Rows that are broken, not numbers,
/// implausible or late are skipped and counted in the notes.
/// @throws DataError "file:line: rule" when the file or a column is missing, columns or units are ambiguous,
///           or no row is usable
/// @throws UsageError when a unit in `columns` is unknown
PressureLog read_pressure_log(const std::filesystem::path& file, const PressureColumns& columns);

}  // namespace isobar::recording
