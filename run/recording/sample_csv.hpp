// SPDX-License-Identifier: BSD-3-Clause
// Rows of the sensor files as samples.
#pragma once

#include <filesystem>
#include <string>

#include "core/samples.hpp"
#include "run/recording/tally.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::recording {

/// Opens a sensor's file with its columns (docs/files-and-formats.md).
/// @throws DataError when the file cannot be read or lacks a column
text::CsvReader open_imu_csv(const std::filesystem::path& file);
text::CsvReader open_pressure_csv(const std::filesystem::path& file);
text::CsvReader open_wheel_csv(const std::filesystem::path& file);

/// Parses the current row as a sample. A pressure without a temperature is good: temperature_c is NaN.
/// @param value text that breaks the rule; may be empty
/// @return the rule that the row breaks, a static text; nullptr when none
const char* parse_row(const text::CsvReader& csv, ImuSample& sample, std::string& value);
const char* parse_row(const text::CsvReader& csv, PressureSample& sample, std::string& value);
const char* parse_row(const text::CsvReader& csv, WheelSample& sample, std::string& value);

/// Moves to the next good row and counts the broken ones; false at the end of the file.
template <typename Sample>
bool next_sample(text::CsvReader& csv, Sample& sample, Tally& malformed, Tally& implausible);

extern template bool next_sample(text::CsvReader&, ImuSample&, Tally&, Tally&);
extern template bool next_sample(text::CsvReader&, PressureSample&, Tally&, Tally&);
extern template bool next_sample(text::CsvReader&, WheelSample&, Tally&, Tally&);

}  // namespace isobar::recording
