// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pressure_header.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

#include "core/errors.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

constexpr std::size_t kLinesSearched = 20;
constexpr std::array kSeparators = {',', ';', '\t'};

using Fields = std::vector<std::string_view>;

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_time(std::string_view name) {
  const std::string text = lower(name);
  return text.starts_with("time") || text.starts_with("date") || text.starts_with("stamp") || text == "t" ||
         text == "t_ns" || text == "t_us" || text == "t_ms" || text == "t_s";
}

bool is_pressure(std::string_view name) {
  const std::string text = lower(name);
  return text.find("press") != std::string::npos || text.starts_with("baro") || has_word(text, "p") ||
         has_word(text, "pa") || has_word(text, "hpa") || has_word(text, "mbar") || has_word(text, "kpa");
}

bool is_temperature(std::string_view name) {
  const std::string text = lower(name);
  return text.find("temp") != std::string::npos || has_word(text, "ta") || has_word(text, "degc");
}

std::string list_of(const Fields& names) {
  std::string text;
  for (const std::string_view name : names) {
    text += (text.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  return text;
}

/// Search for one column: the one named by the user, or the only candidate. Records why there is none.
struct Search {
  const Fields& fields;
  std::string missing{};
  std::string ambiguous{};

  std::string find(const std::string& wanted, bool (*looks_like_it)(std::string_view), const char* what) {
    if (!wanted.empty()) {
      if (std::find(fields.begin(), fields.end(), wanted) != fields.end()) {
        return wanted;
      }
      missing = "column '" + wanted + "' is missing";
      return {};
    }
    Fields candidates;
    std::copy_if(fields.begin(), fields.end(), std::back_inserter(candidates), looks_like_it);
    if (candidates.size() == 1) {
      return std::string(candidates.front());
    }
    (candidates.empty() ? missing : ambiguous) =
        candidates.empty() ? "no column looks like the " + std::string(what)
                           : list_of(candidates) + " could all be the " + what + ": name one of them";
    return {};
  }
};

/// A line interpreted as the header.
struct Attempt {
  PressureHeader header;
  std::string rule;       ///< broken rule; empty: complete
  std::size_t found = 0;  ///< required columns found
};

Attempt try_header(const Fields& fields, const PressureColumns& wanted) {
  Attempt attempt;
  Search search{fields};
  attempt.header.time = search.find(wanted.time, is_time, "time");
  attempt.header.pressure = search.find(wanted.pressure, is_pressure, "pressure");
  attempt.found = (attempt.header.time.empty() ? 0U : 1U) + (attempt.header.pressure.empty() ? 0U : 1U);
  if (wanted.needs_temperature) {
    Search thermometer{fields};
    attempt.header.temperature = thermometer.find(wanted.temperature, is_temperature, "temperature");
    // A sensor may have no thermometer; but a named column must exist, and an ambiguous one must be named.
    if (!wanted.temperature.empty() && search.missing.empty()) {
      search.missing = thermometer.missing;
    }
    if (search.ambiguous.empty()) {
      search.ambiguous = thermometer.ambiguous;
    }
  }
  attempt.rule =
      search.missing.empty() ? search.ambiguous : search.missing + "; the columns are " + list_of(fields);
  return attempt;
}

}  // namespace

bool has_word(std::string_view name, std::string_view word) {
  const std::string text = lower(name);
  const auto is_part = [&text](std::size_t k) {
    return k < text.size() && std::isalnum(static_cast<unsigned char>(text[k])) != 0;
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if ((at == 0 || !is_part(at - 1)) && !is_part(at + word.size())) {
      return true;
    }
  }
  return false;
}

PressureHeader find_pressure_header(const std::filesystem::path& file, const PressureColumns& wanted) {
  text::TextLines lines(file);
  std::string_view line;
  Fields fields;
  Attempt nearest;
  nearest.header.format.header_line = 0;  // none yet
  nearest.rule = "is empty, must start with a line that names the columns";
  std::size_t nearest_line = 1;
  while (lines.line_number() < kLinesSearched && lines.next(line)) {
    if (lines.line_number() == 1 && !text::trimmed(line).empty()) {
      nearest.rule = "must name columns separated by comma, semicolon or tab";
    }
    for (const char separator : kSeparators) {
      text::split_fields(line, separator, fields);
      if (fields.size() < 2) {
        continue;
      }
      Attempt attempt = try_header(fields, wanted);
      attempt.header.format = {separator, lines.line_number()};
      if (attempt.rule.empty()) {
        return attempt.header;
      }
      if (nearest.header.format.header_line == 0 || attempt.found > nearest.found) {
        nearest = attempt;
        nearest_line = lines.line_number();
      }
    }
  }
  throw DataError(file.string() + ":" + std::to_string(nearest_line) + ": " + nearest.rule);
}

}  // namespace isobar::recording
