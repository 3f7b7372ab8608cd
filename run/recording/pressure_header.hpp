// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "run/recording/pressure_log.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::recording {

/// What the columns of time hold.
enum class TimeLayout : std::uint8_t {
  kOneColumn,
  kDateAndTime,            ///< the date in `time`, the time of day in `time_rest`
  kSecondsAndNanoseconds,  ///< whole seconds in `time`, the rest in `time_rest`
  kSecondsAndMicroseconds,
};

/// Header line of a logger's CSV and the names of the columns to read.
struct PressureHeader {
  text::CsvFormat format;
  std::string time;
  std::string time_rest;  ///< second column of the time; empty with kOneColumn
  TimeLayout time_layout = TimeLayout::kOneColumn;
  std::string pressure;
  std::string temperature;  ///< empty: there is none
};

/// Finds the header among the first lines: the line with every column that `wanted` names, and with exactly
/// one candidate for each that it leaves open. Two columns that are one time together count as one candidate.
/// @throws DataError when a column is missing or several could be meant; the text names them
PressureHeader find_pressure_header(const std::filesystem::path& file, const PressureColumns& wanted);

/// True when `name` contains `word` as a whole word (letters and digits), in upper or lower case.
bool has_word(std::string_view name, std::string_view word);

}  // namespace isobar::recording
