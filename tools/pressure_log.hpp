// SPDX-License-Identifier: BSD-3-Clause
// A barometer's CSV file, of a recording or of anybody's logger.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.hpp"

namespace isobar::tools {

/// Which columns hold what. The defaults are those of a recording's barometer.csv.
struct PressureColumns {
  std::string time = "t_ns";
  double ns_per_unit = 1.0;  ///< of the time column
  std::string pressure = "pressure_pa";
  double pa_per_unit = 1.0;                   ///< of the pressure column
  std::string temperature = "temperature_c";  ///< may be missing from the file
};

/// "TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE]", units ns (default), us, ms, s and Pa (default), hPa, kPa.
/// Throws UsageError.
PressureColumns parse_columns(const std::string& text);

/// What --columns says in a command's help.
inline constexpr const char* kColumnsHelp =
    "TIME[:ns|us|ms|s],PRESSURE[:Pa|hPa|kPa][,TEMPERATURE]: other names of the columns, their units";

struct PressureLog {
  std::vector<PressureSample> samples;  ///< stamps ascend, no value twice in a row
  std::uint64_t repeats = 0;   ///< rows with the value before, bit for bit: polled faster than converted
  std::uint64_t bad_rows = 0;  ///< left out: no numbers, out of range, not newer than the row before
  std::string first_bad_row;   ///< "file:line: rule"

  [[nodiscard]] std::vector<double> times_s() const;  ///< since the first sample
  [[nodiscard]] std::vector<double> pressures_pa() const;
};

/// Throws DataError: no such file or column; no good row; pressures in hPa or kPa, which are named, not
/// guessed; more bad rows than good ones.
PressureLog read_pressure_log(const std::filesystem::path& file, const PressureColumns& columns = {});

/// One line about what was left out of a file, empty where nothing was.
std::string left_out(const PressureLog& log);

/// Moves a base's stamps to the other log's clock (recording/base_clock.hpp); returns how, in words.
std::string tie_clocks(const PressureLog& moved, PressureLog& standing);

/// Mean temperature of the coldest sensor: chips warm themselves, so it is the nearest to the air. Nothing
/// where none has a thermometer.
std::optional<double> coldest_c(std::initializer_list<const std::vector<PressureSample>*> logs);

}  // namespace isobar::tools
