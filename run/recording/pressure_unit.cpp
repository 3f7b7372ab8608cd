// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pressure_unit.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <vector>

#include "core/errors.hpp"
#include "core/plausibility.hpp"

namespace isobar::recording {
namespace {

// At most one unit can fit: highest / lowest is below 10.
static_assert(kGroundPressurePa.highest < 10.0 * kGroundPressurePa.lowest);

bool fits(double median, PressureUnit unit) { return kGroundPressurePa.holds(median * pascals_per(unit)); }

std::string short_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// Units among the words of a name.
std::vector<PressureUnit> units_in(std::string_view name) {
  std::vector<PressureUnit> units;
  std::string word;
  for (std::size_t k = 0; k <= name.size(); ++k) {
    if (k < name.size() && std::isalnum(static_cast<unsigned char>(name[k])) != 0) {
      word += name[k];
      continue;
    }
    const auto unit = unit_of_word(word);
    if (unit && std::find(units.begin(), units.end(), *unit) == units.end()) {
      units.push_back(*unit);
    }
    word.clear();
  }
  return units;
}

UnitFinding checked(PressureUnit unit, const std::string& reason, const UnitClues& clues,
                    const std::string& place) {
  if (fits(clues.median, unit)) {
    return {unit, reason};
  }
  const std::string name(kPressureUnitNames.name(unit));
  throw DataError(place + "pressure is in " + name + ", " + reason + ", but its median, " +
                  short_text(clues.median) + " " + name + ", is not an air pressure");
}

}  // namespace

double pascals_per(PressureUnit unit) {
  switch (unit) {
    case PressureUnit::kPa:
      return 1.0;
    case PressureUnit::kHectopascal:
      return 100.0;
    case PressureUnit::kKilopascal:
      return 1000.0;
  }
  return 1.0;
}

std::optional<PressureUnit> unit_of_word(std::string_view word) {
  std::string lower;
  for (const char c : word) {
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (lower == "pa") {
    return PressureUnit::kPa;
  }
  if (lower == "hpa" || lower == "mbar" || lower == "mb" || lower == "millibar") {
    return PressureUnit::kHectopascal;
  }
  if (lower == "kpa") {
    return PressureUnit::kKilopascal;
  }
  return std::nullopt;
}

UnitFinding find_unit(const UnitClues& clues, const std::string& place) {
  if (!clues.chosen.empty()) {
    const auto unit = unit_of_word(clues.chosen);
    if (!unit) {
      throw UsageError("unit of pressure: must be Pa, hPa, mbar or kPa (got '" + clues.chosen + "')");
    }
    return checked(*unit, "as the command line says", clues, place);
  }
  std::vector<PressureUnit> named = units_in(clues.column_name);
  for (const PressureUnit unit : units_in(clues.units_line)) {
    if (std::find(named.begin(), named.end(), unit) == named.end()) {
      named.push_back(unit);
    }
  }
  if (named.size() > 1) {
    throw DataError(place + "the header names more than one unit of pressure: name one on the command line");
  }
  if (named.size() == 1) {
    return checked(
        named.front(),
        units_in(clues.column_name).empty() ? "as the line of units says" : "as the column's name says",
        clues, place);
  }
  for (const auto& [unit, name] : kPressureUnitNames.entries) {
    if (fits(clues.median, unit)) {
      return {unit,
              "the only unit in which its median, " + short_text(clues.median) + ", is an air pressure"};
    }
  }
  throw DataError(place + "the unit of pressure is unknown: its median, " + short_text(clues.median) +
                  ", is not an air pressure in Pa, hPa or kPa");
}

}  // namespace isobar::recording
