// SPDX-License-Identifier: BSD-3-Clause
// Pressure from any logger's CSV: which columns, units and clock it uses is found out and said.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/samples.hpp"

namespace isobar::recording {

/// Columns by name; what is empty is found out from the header.
struct PressureColumns {
  std::string time;
  std::string pressure;
  std::string temperature;
  std::string pressure_unit;  ///< Pa, hPa, mbar or kPa
  std::string time_unit;      ///< ns, us, ms, s
  bool needs_temperature = true;
};

struct PressureLog {
  std::string file;
  std::vector<PressureSample> samples;  ///< ascending in time; temperature_c NaN where there is none
  bool has_temperature = false;         ///< the file has a column for it
  std::vector<std::string> notes;       ///< what was found out, and what was refused and counted
};

/// Reads one file. The separator may be a comma, a semicolon or a tab; lines of a logger's own may stand
/// before the header, and lines of units below it. Rows that are broken, not a number, implausible or not
/// newer than those before are left out and counted in the notes. Throws DataError "file:line: rule": no such
/// file or column, columns or units that cannot be told apart, no usable row.
PressureLog read_pressure_log(const std::filesystem::path& file, const PressureColumns& columns);

}  // namespace isobar::recording
