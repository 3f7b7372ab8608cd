// SPDX-License-Identifier: BSD-3-Clause
// Which unit a column of pressures is in, and how that is known.
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

/// The unit that a word names: Pa, hPa, mbar, mb, millibar, kPa, in any case.
std::optional<PressureUnit> unit_of_word(std::string_view word);

struct UnitFinding {
  PressureUnit unit = PressureUnit::kPa;
  std::string reason;  ///< "as the column's name says", …
};

/// What is known of a column before its unit is.
struct UnitClues {
  std::string chosen;       ///< by the person; empty: nothing
  std::string column_name;  ///< may name the unit: p_mbar
  std::string units_line;   ///< what a line of units below the header says of it
  double median = 0.0;      ///< of its values
};

/// The unit that the clues agree on: chosen, named, or the only one in which the median is an air pressure
/// (30 to 115 kPa, ranges that no two units share). Throws DataError with the rule where they contradict each
/// other or fit none; `place` ("file: ") goes before it.
UnitFinding find_unit(const UnitClues& clues, const std::string& place);

}  // namespace isobar::recording
