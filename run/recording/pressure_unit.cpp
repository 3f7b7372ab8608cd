// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pressure_unit.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/recording/unit_words.hpp"

namespace isobar::recording {
namespace {

// Units of pressure that loggers write and that are not converted: pressures above the air's, or rare.
constexpr std::array<std::string_view, 16> kOtherPressureUnits{
    "barg",  "psig",  "psf",   "mpa",   "dbar", "ubar", "mtorr", "cmhg",
    "mmh2o", "cmh2o", "inh2o", "fth2o", "mh2o", "kgf",  "ksc",   "dyn"};
constexpr std::array<std::string_view, 2> kOtherTemperatureUnits{"rankine", "degr"};

// A column without a unit whose median lies here may be in mmHg or inHg as well: 850 … 1070 hPa in these.
constexpr PlausibleRange kLooksLikeMmHg{638.0, 803.0};
constexpr PlausibleRange kLooksLikeInHg{25.1, 31.6};
// The highest median of a thermometer without a unit that is taken as degC; a warm day in degF is above.
constexpr double kWarmestUnnamedC = 60.0;

bool fits(double median, PressureUnit unit) { return kGroundPressurePa.holds(median * pascals_per(unit)); }

std::string short_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

bool is_pressure_unit(const std::string& word) { return unit_of_word(word).has_value(); }
bool is_temperature_unit(const std::string& word) { return temperature_unit_of_word(word).has_value(); }

/// A kind of quantity with its units.
template <typename Unit>
struct Quantity {
  const char* name;
  const char* remedy;
  std::optional<Unit> (*unit_of)(std::string_view);
  bool (*is_unit)(const std::string&);
  std::span<const std::string_view> others;  // units that are known and not converted
};

constexpr Quantity<PressureUnit> kPressureQuantity{"pressure", "PRESSURE:UNIT", &unit_of_word,
                                                   &is_pressure_unit, kOtherPressureUnits};
constexpr Quantity<TemperatureUnit> kTemperatureQuantity{"temperature", "TEMPERATURE:UNIT",
                                                         &temperature_unit_of_word, &is_temperature_unit,
                                                         kOtherTemperatureUnits};

/// The unit that a text names as one that cannot be converted; empty: none.
template <typename Unit>
std::string unknown_in(std::string_view text, bool whole, const Quantity<Unit>& quantity) {
  for (const std::string& word : unit_words(text)) {
    if (std::find(quantity.others.begin(), quantity.others.end(), word) != quantity.others.end()) return word;
  }
  return unknown_unit(text, whole, quantity.is_unit);
}

/// The unit that the header names; nothing when it names none.
template <typename Unit>
std::optional<UnitFinding<Unit>> named_unit(const UnitClues& clues, const Quantity<Unit>& quantity,
                                            const std::string& place) {
  for (const bool whole : {false, true}) {
    const std::string unknown = unknown_in(whole ? clues.units_line : clues.column_name, whole, quantity);
    if (!unknown.empty()) {
      throw DataError(std::string(place)
                          .append("the header names '")
                          .append(unknown)
                          .append("' as the unit of ")
                          .append(quantity.name)
                          .append(", which is not known: name a known one with --columns …,")
                          .append(quantity.remedy));
    }
  }
  std::vector<Unit> named = units_in(clues.column_name, quantity.unit_of);
  const bool by_name = !named.empty();
  for (const Unit unit : units_in(clues.units_line, quantity.unit_of)) {
    if (std::find(named.begin(), named.end(), unit) == named.end()) named.push_back(unit);
  }
  if (named.size() > 1) {
    throw DataError(place + "the header names more than one unit of " + quantity.name +
                    ": name one on the command line");
  }
  if (named.empty()) return std::nullopt;
  return UnitFinding<Unit>{named.front(),
                           by_name ? "as the column's name says" : "as the line of units says"};
}

UnitFinding<PressureUnit> checked(UnitFinding<PressureUnit> finding, const UnitClues& clues,
                                  const std::string& place) {
  if (fits(clues.median, finding.unit)) return finding;
  const std::string name(kPressureUnitNames.name(finding.unit));
  throw DataError(place + "pressure is in " + name + ", " + finding.reason + ", but its median, " +
                  short_text(clues.median) + " " + name + ", is not an air pressure");
}

UnitFinding<PressureUnit> guessed(const UnitClues& clues, const std::string& place) {
  const std::string median = short_text(clues.median);
  for (const PressureUnit unit : {PressureUnit::kPa, PressureUnit::kHectopascal, PressureUnit::kKilopascal}) {
    if (!fits(clues.median, unit)) continue;
    const bool mmhg = unit == PressureUnit::kHectopascal && kLooksLikeMmHg.holds(clues.median);
    const bool inhg = unit == PressureUnit::kKilopascal && kLooksLikeInHg.holds(clues.median);
    if (!mmhg && !inhg) {
      return {unit, "the only unit in which its median, " + median + ", is an air pressure"};
    }
    throw DataError(std::string(place)
                        .append("the unit of pressure cannot be told: its median, ")
                        .append(median)
                        .append(", is an air pressure in ")
                        .append(kPressureUnitNames.name(unit))
                        .append(mmhg ? " and in mmHg" : " and in inHg")
                        .append(": name one with --columns …,")
                        .append(kPressureQuantity.remedy));
  }
  throw DataError(place + "the unit of pressure is unknown: its median, " + median +
                  ", is not an air pressure in Pa, hPa or kPa");
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
    case PressureUnit::kBar:
      return 100'000.0;
    // Conventional factors of NIST SP 811, appendix B.
    case PressureUnit::kMmHg:
      return 133.3224;
    case PressureUnit::kTorr:
      return 101'325.0 / 760.0;
    case PressureUnit::kInHg:
      return 3'386.389;
    case PressureUnit::kPsi:
      return 6'894.757;
    case PressureUnit::kAtm:
      return 101'325.0;
  }
  return 1.0;
}

std::optional<PressureUnit> unit_of_word(std::string_view word) {
  const std::string lower = lower_case(word);
  struct Spelling {
    std::string_view word;
    PressureUnit unit;
  };
  constexpr std::array<Spelling, 12> kSpellings{{{"mbar", PressureUnit::kHectopascal},
                                                 {"mb", PressureUnit::kHectopascal},
                                                 {"millibar", PressureUnit::kHectopascal},
                                                 {"millibars", PressureUnit::kHectopascal},
                                                 {"hectopascal", PressureUnit::kHectopascal},
                                                 {"hectopascals", PressureUnit::kHectopascal},
                                                 {"pascal", PressureUnit::kPa},
                                                 {"pascals", PressureUnit::kPa},
                                                 {"kilopascal", PressureUnit::kKilopascal},
                                                 {"kilopascals", PressureUnit::kKilopascal},
                                                 {"atmospheres", PressureUnit::kAtm},
                                                 {"psia", PressureUnit::kPsi}}};
  for (const Spelling& spelling : kSpellings) {
    if (lower == spelling.word) return spelling.unit;
  }
  for (const auto& [unit, name] : kPressureUnitNames.entries) {
    if (lower == lower_case(name)) return unit;
  }
  return std::nullopt;
}

double celsius_of(double value, TemperatureUnit unit) {
  switch (unit) {
    case TemperatureUnit::kCelsius:
      return value;
    case TemperatureUnit::kKelvin:
      return value - 273.15;
    case TemperatureUnit::kFahrenheit:
      return (value - 32.0) / 1.8;
  }
  return value;
}

std::optional<TemperatureUnit> temperature_unit_of_word(std::string_view word) {
  const std::string lower = lower_case(word);
  for (const std::string_view name : {"c", "degc", "celsius", "centigrade"}) {
    if (lower == name) return TemperatureUnit::kCelsius;
  }
  for (const std::string_view name : {"k", "degk", "kelvin"}) {
    if (lower == name) return TemperatureUnit::kKelvin;
  }
  for (const std::string_view name : {"f", "degf", "fahrenheit"}) {
    if (lower == name) return TemperatureUnit::kFahrenheit;
  }
  return std::nullopt;
}

UnitFinding<PressureUnit> find_unit(const UnitClues& clues, const std::string& place) {
  if (!clues.chosen.empty()) {
    const auto unit = unit_of_word(clues.chosen);
    if (!unit) {
      throw UsageError("unit of pressure: must be mbar or one of " + kPressureUnitNames.joined() + " (got '" +
                       clues.chosen + "')");
    }
    return checked({*unit, "as the command line says"}, clues, place);
  }
  if (auto named = named_unit(clues, kPressureQuantity, place))
    return checked(std::move(*named), clues, place);
  return guessed(clues, place);
}

UnitFinding<TemperatureUnit> find_temperature_unit(const UnitClues& clues, const std::string& place) {
  if (!clues.chosen.empty()) {
    const auto unit = temperature_unit_of_word(clues.chosen);
    if (!unit) throw UsageError("unit of temperature: must be C, K or F (got '" + clues.chosen + "')");
    return {*unit, "as the command line says"};
  }
  if (auto named = named_unit(clues, kTemperatureQuantity, place)) return std::move(*named);
  if (clues.median > kWarmestUnnamedC && clues.median <= kPlausibleTemperatureC.highest) {
    throw DataError(place + "the unit of temperature cannot be told: its median, " +
                    short_text(clues.median) + ", is hot in degC: name one with --columns …," +
                    kTemperatureQuantity.remedy);
  }
  return {TemperatureUnit::kCelsius, "since its name names no unit"};
}

}  // namespace isobar::recording
