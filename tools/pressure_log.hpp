// SPDX-License-Identifier: BSD-3-Clause
// A barometer's CSV file, for the commands on noise and heights.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/recording/pressure_log.hpp"

namespace CLI {
class App;
}

namespace isobar::tools {

/// Parses "TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE[:UNIT]]". An empty text leaves columns and units to the file's
/// header and values, an empty name or unit leaves that one to them: ",:kPa".
/// @throws UsageError when the text has another form
recording::PressureColumns parse_columns(const std::string& text);

/// Help text of --columns.
inline constexpr const char* kColumnsHelp =
    "TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE[:UNIT]]: columns and units, if the header does not name them; "
    "an empty "
    "name is found in it; "
    "time in "
    "ns, us, ms, s, min or h, pressure in Pa, hPa, kPa, bar, mmHg, torr, inHg, psi or atm, temperature in C, "
    "K or F";

/// Air temperature without --air and without a thermometer.
inline constexpr double kDefaultAirC = 20.0;

/// The hottest air that is believed without --air: deserts reach more only in records, a sensor in the sun every summer.
inline constexpr double kHottestAirC = 45.0;

/// Adds --air, the air temperature [degC].
void add_air_option(CLI::App& command, std::optional<double>& air_c);

/// The measurements of a log.
struct PressureLog {
  std::vector<PressureSample> samples;  ///< stamps ascend
  std::uint64_t repeats =
      0;  ///< rows left out because they repeat a value: the chip was polled faster than it converts
  std::vector<std::string> notes;  ///< columns and units as detected, rows left out and why

  [[nodiscard]] std::vector<double> times_s() const;  ///< since the first sample
  [[nodiscard]] std::vector<double> pressures_pa() const;
};

/// recording::read_pressure_log() without the values that a chip repeats when it is polled faster than it converts.
/// Equal values of a coarse sensor, or of one that is read every some seconds, are measurements and stay.
/// @throws DataError as read_pressure_log()
PressureLog read_new_values(const std::filesystem::path& file,
                            const recording::PressureColumns& columns = {});

/// Shifts the standing log's stamps to the moved log's clock (run/recording/base_clock.hpp).
/// @return a sentence about the shift and its reason
std::string tie_clocks(const PressureLog& moved, PressureLog& standing);

/// Mean temperature of the coldest sensor [degC]: chips warm themselves, so the coldest is nearest to the
/// air's. Nothing without a thermometer.
std::optional<double> coldest_c(std::initializer_list<const std::vector<PressureSample>*> logs);

/// Temperature of the air [degC]: the chosen one, else coldest_c(), else kDefaultAirC.
/// @throws DataError when the coldest thermometer is hotter than any air
double air_c_of(const std::optional<double>& chosen_c,
                std::initializer_list<const std::vector<PressureSample>*> logs);

}  // namespace isobar::tools
