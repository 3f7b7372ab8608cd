// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pressure_header.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <iterator>

#include "core/errors.hpp"
#include "run/recording/pressure_unit.hpp"
#include "run/recording/unit_words.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

constexpr std::size_t kLinesSearched = 20;
constexpr std::array kSeparators = {',', ';', '\t'};

using Fields = std::vector<std::string_view>;

bool is_time(std::string_view name) {
  const std::string text = lower_case(name);
  return text.starts_with("time") || text.starts_with("date") || text.starts_with("stamp") || text == "t" ||
         text == "t_ns" || text == "t_us" || text == "t_ms" || text == "t_s";
}

/// For headers in which no column begins like a time.
bool may_be_time(std::string_view name) {
  constexpr std::array kWords = {"time",    "timestamp", "stamp",   "datetime", "date",   "zeit",
                                 "uhrzeit", "datum",     "elapsed", "uptime",   "millis", "micros",
                                 "seconds", "minutes",   "hours",   "t_min",    "t_h"};
  return std::any_of(kWords.begin(), kWords.end(), [&](const char* word) { return has_word(name, word); });
}

bool is_pressure(std::string_view name) {
  const std::string text = lower_case(name);
  return text.find("press") != std::string::npos || text.find("druck") != std::string::npos ||
         text.starts_with("baro") || has_word(text, "p") || !units_in(name, &unit_of_word).empty();
}

bool is_temperature(std::string_view name) {
  const std::string text = lower_case(name);
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

/// The column of whole seconds and the one of the rest below a second, as ROS 2 writes them: header.stamp.sec.
struct TimePair {
  std::string_view first;
  std::string_view second;
  TimeLayout layout = TimeLayout::kOneColumn;
};

/// Last word of a name; `rest` is what stands before it.
std::string last_word(std::string_view name, std::string& rest) {
  std::size_t begin = name.size();
  while (begin > 0 && std::isalnum(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
  rest = lower_case(name.substr(0, begin));
  return lower_case(name.substr(begin));
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* other) { return word == other; });
}

std::vector<TimePair> second_pairs(const Fields& fields) {
  std::vector<TimePair> pairs;
  std::string rest;
  std::string other_rest;
  for (const std::string_view seconds : fields) {
    if (!is_one_of(last_word(seconds, rest), {"sec", "secs", "second", "seconds"})) continue;
    for (const std::string_view below : fields) {
      const std::string word = last_word(below, other_rest);
      if (rest != other_rest) continue;
      if (is_one_of(word, {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"})) {
        pairs.push_back({seconds, below, TimeLayout::kSecondsAndNanoseconds});
      } else if (is_one_of(word, {"usec", "usecs", "microsec", "microseconds"})) {
        pairs.push_back({seconds, below, TimeLayout::kSecondsAndMicroseconds});
      }
    }
  }
  return pairs;
}

/// True when a name has one of `wanted` as a word and else only zones.
bool is_only(std::string_view name, std::initializer_list<const char*> wanted) {
  bool found = false;
  for (const std::string& word : unit_words(name)) {
    if (is_one_of(word, wanted)) {
      found = true;
    } else if (!is_one_of(word, {"utc", "gmt", "local", "lt"})) {
      return false;
    }
  }
  return found;
}

std::vector<TimePair> date_pairs(const Fields& fields) {
  std::vector<TimePair> pairs;
  for (const std::string_view date : fields) {
    if (!is_only(date, {"date", "datum", "day"})) continue;
    for (const std::string_view time : fields) {
      if (is_only(time, {"time", "zeit", "uhrzeit", "heure"})) {
        pairs.push_back({date, time, TimeLayout::kDateAndTime});
      }
    }
  }
  return pairs;
}

/// The columns of the time: a pair, the one named by the user with its other half, or the only candidate.
void find_time(Search& search, const PressureColumns& wanted, PressureHeader& header) {
  std::vector<TimePair> pairs = second_pairs(search.fields);
  // A unit on the command line says that the column is a number and no time of day.
  if (wanted.time_unit.empty() || wanted.time.empty()) {
    const std::vector<TimePair> dates = date_pairs(search.fields);
    pairs.insert(pairs.end(), dates.begin(), dates.end());
  }
  std::erase_if(pairs, [&](const TimePair& pair) {
    const auto in_pair = [&](std::string_view name) { return name == pair.first || name == pair.second; };
    const bool other_candidate = std::any_of(search.fields.begin(), search.fields.end(),
                                             [&](auto name) { return is_time(name) && !in_pair(name); });
    return wanted.time.empty() ? other_candidate : !in_pair(wanted.time);
  });
  if (pairs.size() == 1) {
    header.time = pairs.front().first;
    header.time_rest = pairs.front().second;
    header.time_layout = pairs.front().layout;
    return;
  }
  const bool begins_like_one = std::any_of(search.fields.begin(), search.fields.end(), is_time);
  header.time = search.find(wanted.time, begins_like_one ? is_time : may_be_time, "time");
}

/// A line interpreted as the header.
struct Attempt {
  PressureHeader header;
  std::string rule;       ///< broken rule; empty: complete
  std::size_t found = 0;  ///< required columns found
};

Attempt try_header(const Fields& fields, const PressureColumns& wanted) {
  Attempt attempt;
  Search search{fields};
  find_time(search, wanted, attempt.header);
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
  const std::string text = lower_case(name);
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
