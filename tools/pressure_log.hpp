// SPDX-License-Identifier: BSD-3-Clause
// A barometer's CSV file, as the commands use it that look at its noise and heights.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/recording/pressure_log.hpp"

namespace isobar::tools {

/// "TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE]", for files whose columns or units are not found out from their
/// header. Empty: they are. Throws UsageError.
recording::PressureColumns parse_columns(const std::string& text);

/// What --columns says in a command's help.
inline constexpr const char* kColumnsHelp =
    "TIME[:ns|us|ms|s],PRESSURE[:Pa|hPa|kPa][,TEMPERATURE]: which columns and units, where the file's header "
    "does not tell";

/// The samples of a log that are new conversions.
struct PressureLog {
  std::vector<PressureSample> samples;  ///< stamps ascend, no value twice in a row
  std::uint64_t repeats = 0;       ///< rows with the value before, bit for bit: polled faster than converted
  std::vector<std::string> notes;  ///< columns and units as found out, what was left out and why

  [[nodiscard]] std::vector<double> times_s() const;  ///< since the first sample
  [[nodiscard]] std::vector<double> pressures_pa() const;
};

/// recording::read_pressure_log() without the repeats. Throws DataError.
PressureLog read_new_values(const std::filesystem::path& file,
                            const recording::PressureColumns& columns = {});

/// Moves a base's stamps to the other log's clock (recording/base_clock.hpp); returns how, in words.
std::string tie_clocks(const PressureLog& moved, PressureLog& standing);

/// Mean temperature of the coldest sensor: chips warm themselves, so it is the nearest to the air. Nothing
/// where none has a thermometer.
std::optional<double> coldest_c(std::initializer_list<const std::vector<PressureSample>*> logs);

}  // namespace isobar::tools
