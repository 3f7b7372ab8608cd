// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pressure_log.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "core/statistics/distribution.hpp"
#include "run/recording/pressure_header.hpp"
#include "run/recording/pressure_unit.hpp"
#include "run/recording/row_times.hpp"
#include "run/recording/tally.hpp"
#include "run/recording/time_column.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// A line of units, one of the kind of value ("Avg") and a spare one may follow the header.
constexpr std::size_t kLinesBelowHeader = 3;

/// Columns of the reader.
struct Columns {
  static constexpr std::size_t kTime = 0;
  static constexpr std::size_t kPressure = 1;
  std::size_t time_rest;
  std::size_t temperature;
};

/// Rows in the order of the file, pressure and temperature in the file's units.
struct RawLog {
  std::vector<PressureSample> rows;
  std::vector<std::size_t> lines;  ///< of the rows in the file
  bool has_temperature = false;
  Tally broken;
  std::string pressure_units_line;
  std::string temperature_units_line;
};

std::string with_value(const text::CsvReader& csv, const std::string& rule, std::string_view value) {
  return csv.lines().place() + rule + " (is '" + std::string(value) + "')";
}

void read_rows(text::CsvReader& csv, const Columns& columns, const PressureHeader& header, TimeColumn& time,
               RawLog& log) {
  const auto number = [&](std::size_t column, double& value) {
    return text::parse_number(with_decimal_point(csv.field(column)), value);
  };
  std::size_t below_header = 0;
  for (auto row = csv.next(); row != text::CsvReader::Row::kEnd; row = csv.next()) {
    if (row == text::CsvReader::Row::kBad) {
      log.broken.add([&csv] { return csv.bad_row_message(); });
      continue;
    }
    PressureSample sample;
    const std::string_view rest =
        header.time_rest.empty() ? std::string_view{} : csv.field(columns.time_rest);
    const bool has_time = time.parse(csv.field(Columns::kTime), rest, csv.lines().place(), sample.stamp_ns);
    const bool has_pressure =
        number(Columns::kPressure, sample.pressure_pa) && std::isfinite(sample.pressure_pa);
    if (!has_time && !has_pressure && log.rows.empty() && below_header < kLinesBelowHeader) {
      ++below_header;
      if (log.pressure_units_line.empty()) {
        log.pressure_units_line = csv.field(Columns::kPressure);
        if (log.has_temperature) log.temperature_units_line = csv.field(columns.temperature);
      }
    } else if (!has_time || implausible_stamp(sample.stamp_ns) != nullptr) {
      log.broken.add([&csv] { return with_value(csv, "has no time", csv.field(Columns::kTime)); });
    } else if (!has_pressure) {
      log.broken.add([&csv] { return with_value(csv, "has no pressure", csv.field(Columns::kPressure)); });
    } else {
      if (!log.has_temperature || !number(columns.temperature, sample.temperature_c)) {
        sample.temperature_c = kNone;
      }
      log.rows.push_back(sample);
      log.lines.push_back(csv.lines().line_number());
    }
  }
}

/// Median of the values that are numbers; NaN without one.
double median_of(const std::vector<PressureSample>& rows, double PressureSample::*member) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const PressureSample& row : rows) {
    if (std::isfinite(row.*member)) values.push_back(row.*member);
  }
  return values.empty() ? kNone : median(std::move(values));
}

/// Converts the units; drops implausible rows.
void keep_plausible(std::vector<PressureSample>& rows, PressureUnit unit, TemperatureUnit temperature_unit,
                    Tally& implausible) {
  std::erase_if(rows, [&](PressureSample& row) {
    row.pressure_pa *= pascals_per(unit);
    row.temperature_c = celsius_of(row.temperature_c, temperature_unit);
    const char* rule = implausibility(row);
    if (rule != nullptr) {
      implausible.add([&] { return std::string(rule); });
    }
    return rule != nullptr;
  });
}

void add_count(const Tally& tally, const std::string& what, PressureLog& log) {
  if (tally.count > 0) {
    log.notes.push_back(what + std::to_string(tally.count) + " (first: " + tally.first_message + ")");
  }
}

std::string seconds_text(std::int64_t ns) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.6g s", static_cast<double>(ns) * 1e-9);
  return text.data();
}

void note_times(const RowTimes& times, const std::vector<std::size_t>& lines, PressureLog& log) {
  const auto add = [&log](std::uint64_t count, const std::string& what) {
    if (count > 0) log.notes.push_back(what + std::to_string(count));
  };
  add(times.spread, "rows spread over the " + seconds_text(times.interval_ns) +
                        " that the clock shows, since they share their time with others: ");
  add(times.repeated, "rows left out that repeat the time of the row before: ");
  add(times.late, "rows left out whose time goes back, while the rows after them go on: ");
  if (times.steps_back > 0) {
    log.notes.push_back(log.file + ":" + std::to_string(lines[times.first_step_row]) +
                        ": the clock was set back by " + seconds_text(times.first_step_ns) +
                        "; the rows from there on go on without it" +
                        (times.steps_back == 1 ? "" : ", the first of " + std::to_string(times.steps_back)));
  }
}

/// Finds the units and converts.
void convert_units(const PressureHeader& header, const PressureColumns& columns, RawLog& raw,
                   PressureLog& log) {
  const std::string place = log.file + ": ";
  const auto unit = find_unit({columns.pressure_unit, header.pressure, raw.pressure_units_line,
                               median_of(raw.rows, &PressureSample::pressure_pa)},
                              place);
  log.notes.push_back("pressure is in " + std::string(kPressureUnitNames.name(unit.unit)) + " (column '" +
                      header.pressure + "', " + unit.reason + ")");
  TemperatureUnit temperature_unit = TemperatureUnit::kCelsius;
  std::string temperature_note;
  if (log.has_temperature) {
    const auto found =
        find_temperature_unit({columns.temperature_unit, header.temperature, raw.temperature_units_line,
                               median_of(raw.rows, &PressureSample::temperature_c)},
                              place);
    temperature_unit = found.unit;
    temperature_note = "temperature is in " + std::string(kTemperatureUnitNames.name(found.unit)) +
                       " (column '" + header.temperature + "', " + found.reason + ")";
  }
  Tally implausible;
  keep_plausible(raw.rows, unit.unit, temperature_unit, implausible);
  if (raw.rows.empty()) {
    throw DataError(place + implausible.first_message + ": none of " + std::to_string(implausible.count) +
                    " rows can be used");
  }
  if (!temperature_note.empty()) log.notes.push_back(temperature_note);
  add_count(implausible, "rows left out that are implausible: ", log);
}

}  // namespace

PressureLog read_pressure_log(const std::filesystem::path& file, const PressureColumns& columns) {
  const PressureHeader header = find_pressure_header(file, columns);
  std::vector<std::string_view> names{header.time, header.pressure};
  Columns at{names.size(), names.size()};
  if (!header.time_rest.empty()) {
    names.emplace_back(header.time_rest);
    at.temperature = names.size();
  }
  if (!header.temperature.empty()) names.emplace_back(header.temperature);
  text::CsvReader csv(text::TextLines(file), names, {}, header.format);
  TimeColumn time(header, columns.time_unit);
  RawLog raw;
  raw.has_temperature = !header.temperature.empty();
  read_rows(csv, at, header, time, raw);
  PressureLog log;
  log.file = file.string();
  log.has_temperature = raw.has_temperature;
  if (raw.rows.empty()) {
    throw DataError(raw.broken.count == 0 ? log.file + ":" + std::to_string(csv.lines().line_number()) +
                                                ": has no row below the line that names the columns"
                                          : raw.broken.first_message + "; none of " +
                                                std::to_string(raw.broken.count) + " rows can be used");
  }
  const RowTimes times = straighten_times(raw.rows);
  convert_units(header, columns, raw, log);
  log.notes.push_back(time.note());
  add_count(raw.broken, "rows left out that are no numbers: ", log);
  note_times(times, raw.lines, log);
  if (const std::string damage = csv.lines().damage(); !damage.empty()) log.notes.push_back(damage);
  log.samples = std::move(raw.rows);
  return log;
}

}  // namespace isobar::recording
