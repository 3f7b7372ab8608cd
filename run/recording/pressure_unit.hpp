// SPDX-License-Identifier: BSD-3-Clause
// Units of a pressure column and of a temperature column, from the command line, the header or the values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/name_table.hpp"

namespace isobar::recording {

enum class PressureUnit : std::uint8_t {
  kPa,
  kHectopascal,
  kKilopascal,
  kBar,
  kMmHg,
  kTorr,
  kInHg,
  kPsi,
  kAtm
};

inline constexpr NameTable<PressureUnit, 9> kPressureUnitNames{{{
    {PressureUnit::kPa, "Pa"},
    {PressureUnit::kHectopascal, "hPa"},
    {PressureUnit::kKilopascal, "kPa"},
    {PressureUnit::kBar, "bar"},
    {PressureUnit::kMmHg, "mmHg"},
    {PressureUnit::kTorr, "torr"},
    {PressureUnit::kInHg, "inHg"},
    {PressureUnit::kPsi, "psi"},
    {PressureUnit::kAtm, "atm"},
}}};

double pascals_per(PressureUnit unit);

/// The unit that a word names, in upper or lower case: the names above, mbar, mb, millibar (hPa), psia; nothing for
/// other words.
std::optional<PressureUnit> unit_of_word(std::string_view word);

enum class TemperatureUnit : std::uint8_t { kCelsius, kKelvin, kFahrenheit };

inline constexpr NameTable<TemperatureUnit, 3> kTemperatureUnitNames{{{
    {TemperatureUnit::kCelsius, "degC"},
    {TemperatureUnit::kKelvin, "K"},
    {TemperatureUnit::kFahrenheit, "degF"},
}}};

/// @return degrees Celsius
double celsius_of(double value, TemperatureUnit unit);

/// C, degC, Celsius, K, Kelvin, F, degF, Fahrenheit, in upper or lower case.
std::optional<TemperatureUnit> temperature_unit_of_word(std::string_view word);

template <typename Unit>
struct UnitFinding {
  Unit unit{};
  std::string reason;  ///< "as the column's name says", …
};

/// Evidence for the unit of a column.
struct UnitClues {
  std::string chosen;       ///< unit on the command line; empty: none
  std::string column_name;  ///< may name the unit: p_mbar
  std::string units_line;   ///< the column's field in a line of units below the header; may be empty
  double median = 0.0;      ///< of the values, in the unknown unit
};

/// The unit of a pressure column: chosen, else named, else the only one in which the median lies in kGroundPressurePa.
/// A unit that is named but not known is never replaced by a guess.
/// @param place "file: ", start of the errors
/// @throws DataError when the clues contradict each other, name a unit that is not known, or fit no or several units
/// @throws UsageError when the chosen unit is not known
UnitFinding<PressureUnit> find_unit(const UnitClues& clues, const std::string& place);

/// The unit of a temperature column: chosen, else named, else degC unless the values speak against it.
/// @throws as find_unit()
UnitFinding<TemperatureUnit> find_temperature_unit(const UnitClues& clues, const std::string& place);

}  // namespace isobar::recording
