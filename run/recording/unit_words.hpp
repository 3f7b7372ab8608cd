// SPDX-License-Identifier: BSD-3-Clause
// Units in the names of columns: "pressure_mmHg", "Temp (°F)", "pressureInHg".
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::recording {

/// `text` in lower case (ASCII).
[[nodiscard]] std::string lower_case(std::string_view text);

/// Words (letters and digits) of a name in lower case. "in Hg" and "inches of mercury" become one word, and what follows
/// the quantity in a word is a word of its own: "tempf" gives "tempf" and "f".
[[nodiscard]] std::vector<std::string> unit_words(std::string_view name);

/// The text in brackets that could be a unit and is none of `is_known`: letters that are not only words like "abs" or
/// "avg"; empty: there is none.
/// @param whole the name itself counts as the text in brackets: a field in a line of units
[[nodiscard]] std::string unknown_unit(std::string_view name, bool whole,
                                       bool (*is_known)(const std::string&));

/// Units among the words of a name, each once.
template <typename Unit>
std::vector<Unit> units_in(std::string_view name, std::optional<Unit> (*unit_of)(std::string_view)) {
  std::vector<Unit> units;
  for (const std::string& word : unit_words(name)) {
    const auto unit = unit_of(word);
    if (unit && std::find(units.begin(), units.end(), *unit) == units.end()) units.push_back(*unit);
  }
  return units;
}

}  // namespace isobar::recording
