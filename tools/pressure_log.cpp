// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pressure_log.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

#include "core/altitude/stamp.hpp"
#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "drivers/recording/base_clock.hpp"
#include "drivers/recording/csv_reader.hpp"
#include "drivers/recording/number_text.hpp"

namespace isobar::tools {

namespace {

using recording::CsvReader;
using recording::parse_number;

/// Stamps as whole nanoseconds without the rounding of a double where the file says so.
bool parse_stamp(std::string_view text, double ns_per_unit, std::int64_t& stamp_ns) {
  if (ns_per_unit == 1.0) return parse_number(text, stamp_ns);
  if (ns_per_unit == 1e9 && recording::parse_seconds(text, stamp_ns)) return true;
  std::int64_t whole = 0;
  if (parse_number(text, whole)) {
    const auto factor = static_cast<std::int64_t>(ns_per_unit);
    if (whole > std::numeric_limits<std::int64_t>::max() / factor || whole < 0) return false;
    stamp_ns = whole * factor;
    return true;
  }
  double value = 0.0;
  if (!parse_number(text, value) || !(std::abs(value * ns_per_unit) < 4e18)) return false;
  stamp_ns = std::llround(value * ns_per_unit);
  return true;
}

/// Nothing where the row is good, else the rule it breaks.
std::optional<std::string> parse_row(const CsvReader& csv, const PressureColumns& columns,
                                     PressureSample& sample) {
  const std::string time(csv.field(0));
  if (!parse_stamp(time, columns.ns_per_unit, sample.stamp_ns) || !plausible_stamp(sample.stamp_ns)) {
    return columns.time + " must be a time (is '" + time + "')";
  }
  const std::string pressure(csv.field(1));
  if (!parse_number(pressure, sample.pressure_pa) || !std::isfinite(sample.pressure_pa)) {
    return columns.pressure + " must be a finite number (is '" + pressure + "')";
  }
  sample.pressure_pa *= columns.pa_per_unit;
  if (!kPlausiblePressurePa.holds(sample.pressure_pa)) {
    return columns.pressure + " must lie within 10000 … 120000 Pa (is " + pressure +
           (columns.pa_per_unit == 1.0 ? ")" : " in another unit)");
  }
  if (!parse_number(csv.field(2), sample.temperature_c)) {
    sample.temperature_c = std::numeric_limits<double>::quiet_NaN();
  }
  return std::nullopt;
}

/// Which unit a pressure that cannot be in Pa looks like, where air is between 30 and 115 kPa; empty where
/// none.
std::string likely_unit(double pressure) {
  constexpr PlausibleRange kAirKpa{30.0, 115.0};
  if (kAirKpa.holds(pressure)) return "kPa";
  if (kAirKpa.holds(0.1 * pressure)) return "hPa";
  return "";
}

/// Takes ":UNIT" off a column's name; 1 where there is none.
double take_unit(std::string& name, const std::map<std::string, double>& units, const char* choices) {
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos) return 1.0;
  const auto unit = units.find(name.substr(colon + 1));
  if (unit == units.end()) {
    throw UsageError("--columns: \"" + name.substr(colon + 1) + "\" is none of " + choices);
  }
  name.resize(colon);
  return unit->second;
}

}  // namespace

PressureColumns parse_columns(const std::string& text) {
  static const std::map<std::string, double> kTimes{{"ns", 1.0}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  static const std::map<std::string, double> kPressures{{"Pa", 1.0}, {"hPa", 100.0}, {"kPa", 1000.0}};
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  if (names.size() < 2 || names.size() > 3) {
    throw UsageError("--columns: \"" + text + "\": must be TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE]");
  }
  PressureColumns columns;
  columns.ns_per_unit = take_unit(names[0], kTimes, "ns, us, ms, s");
  columns.pa_per_unit = take_unit(names[1], kPressures, "Pa, hPa, kPa");
  columns.time = names[0];
  columns.pressure = names[1];
  columns.temperature = names.size() > 2 ? names[2] : "";
  return columns;
}

PressureLog read_pressure_log(const std::filesystem::path& file, const PressureColumns& columns) {
  CsvReader csv(file, {columns.time, columns.pressure}, {columns.temperature});
  PressureLog log;
  std::string unit;
  const auto refuse = [&](const std::string& message) {
    if (log.bad_rows++ == 0) log.first_bad_row = message;
  };
  for (CsvReader::Row row = csv.next(); row != CsvReader::Row::kEnd; row = csv.next()) {
    if (row == CsvReader::Row::kBad) {
      refuse(csv.bad_row_message());
      continue;
    }
    PressureSample sample;
    if (const auto rule = parse_row(csv, columns, sample)) {
      if (unit.empty() && columns.pa_per_unit == 1.0) unit = likely_unit(sample.pressure_pa);
      refuse(csv.lines().place() + *rule);
    } else if (!log.samples.empty() && sample.stamp_ns <= log.samples.back().stamp_ns) {
      refuse(csv.lines().place() + columns.time + " must be later than in the row before");
    } else if (!log.samples.empty() && sample.pressure_pa == log.samples.back().pressure_pa) {
      ++log.repeats;
    } else {
      log.samples.push_back(sample);
    }
  }
  if (log.bad_rows > log.samples.size() + log.repeats) {
    const std::string hint = unit.empty() ? "" : "; it looks like " + unit + ", say so with --columns";
    throw DataError(log.first_bad_row + hint + " (" + std::to_string(log.bad_rows) + " rows like this)");
  }
  if (log.samples.empty()) throw DataError(file.string() + ": holds no samples");
  return log;
}

std::vector<double> PressureLog::times_s() const {
  std::vector<double> times;
  times.reserve(samples.size());
  for (const PressureSample& sample : samples) {
    times.push_back(seconds_between(samples.front().stamp_ns, sample.stamp_ns));
  }
  return times;
}

std::vector<double> PressureLog::pressures_pa() const {
  std::vector<double> pressures;
  pressures.reserve(samples.size());
  for (const PressureSample& sample : samples) pressures.push_back(sample.pressure_pa);
  return pressures;
}

std::string left_out(const PressureLog& log) {
  std::string text;
  if (log.repeats > 0) text += std::to_string(log.repeats) + " rows repeat the value before them";
  if (log.bad_rows > 0) {
    text += (text.empty() ? "" : "; ") + std::to_string(log.bad_rows) +
            " bad rows, the first: " + log.first_bad_row;
  }
  return text;
}

std::string tie_clocks(const PressureLog& moved, PressureLog& standing) {
  const auto span = [](const PressureLog& log) {
    return recording::StampSpan{log.samples.front().stamp_ns, log.samples.back().stamp_ns};
  };
  const recording::BaseClock clock = recording::tie_base_clock(span(moved), span(standing));
  for (PressureSample& sample : standing.samples) sample.stamp_ns += clock.offset_ns;
  return clock.reason;
}

std::optional<double> coldest_c(std::initializer_list<const std::vector<PressureSample>*> logs) {
  std::optional<double> coldest;
  for (const std::vector<PressureSample>* log : logs) {
    double sum_c = 0.0;
    double count = 0.0;
    for (const PressureSample& sample : *log) {
      if (!kPlausibleTemperatureC.holds(sample.temperature_c)) continue;
      sum_c += sample.temperature_c;
      count += 1.0;
    }
    if (count > 0.0 && (!coldest || sum_c / count < *coldest)) coldest = sum_c / count;
  }
  return coldest;
}

}  // namespace isobar::tools
