// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "run/recording/pressure_log.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::recording {

/// Where a logger's CSV names its columns, and which of them are meant.
struct PressureHeader {
  text::CsvFormat format;
  std::string time;
  std::string pressure;
  std::string temperature;  ///< empty: there is none
};

/// Looks at the first lines for one that holds all columns that `wanted` names and one each of those that it
/// leaves open. Throws DataError that says what is missing, or which columns could all be meant.
PressureHeader find_pressure_header(const std::filesystem::path& file, const PressureColumns& wanted);

/// Whether a word stands in a name: letters and digits between others, in any case.
bool has_word(std::string_view name, std::string_view word);

}  // namespace isobar::recording
