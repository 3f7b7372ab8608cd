// SPDX-License-Identifier: BSD-3-Clause
// Unit of a pressure column, from the command line, the header or the values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/name_table.hpp"

namespace isobar::recording {

enum class PressureUnit : std::uint8_t { kPa, kHectopascal, kKilopascal };

inline constexpr NameTable<PressureUnit, 3> kPressureUnitNames{{{
    {PressureUnit::kPa, "Pa"},
    {PressureUnit::kHectopascal, "hPa"},
    {PressureUnit::kKilopascal, "kPa"},
}}};

double pascals_per(PressureUnit unit);

/// The unit that a word names: Pa, hPa, mbar, mb, millibar or kPa, in upper or lower case; nothing for other
/// words.
std::optional<PressureUnit> unit_of_word(std::string_view word);

struct UnitFinding {
  PressureUnit unit = PressureUnit::kPa;
  std::string reason;  ///< "as the column's name says", …
};

/// Evidence for the unit of a column.
struct UnitClues {
  std::string chosen;       ///< unit on the command line; empty: none
  std::string column_name;  ///< may name the unit: p_mbar
  std::string units_line;   ///< the column's field in a line of units below the header; may be empty
  double median = 0.0;      ///< of the values, in the unknown unit
};

/// The unit of a column: chosen, else named, else the only one in which the median lies in kGroundPressurePa.
/// @param place "file: ", start of the errors
/// @throws DataError when the clues contradict each other or fit no unit
/// @throws UsageError when the chosen unit is none of Pa, hPa, mbar, kPa
UnitFinding find_unit(const UnitClues& clues, const std::string& place);

}  // namespace isobar::recording
