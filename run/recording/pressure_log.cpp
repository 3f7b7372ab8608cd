// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pressure_log.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "core/statistics/distribution.hpp"
#include "run/recording/date_text.hpp"
#include "run/recording/pressure_header.hpp"
#include "run/recording/pressure_unit.hpp"
#include "run/recording/tally.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// A line of units, one of the kind of value ("Avg") and a spare one may follow the header.
constexpr std::size_t kLinesBelowHeader = 3;
// Largest time, below 2^63.
constexpr double kMostNs = 9.2e18;
enum Column : std::size_t { kTime, kPressure, kTemperature };

/// Unit of the time column.
struct TimeUnit {
  const char* name;
  double ns;
};
constexpr std::array<TimeUnit, 4> kTimeUnits = {{{"ns", 1.0}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}}};

/// Parser of the time column: dates as text, or numbers in the unit that is named or that gives a date of
/// this century.
class TimeColumn {
 public:
  TimeColumn(const PressureHeader& header, const std::string& wanted) : name_(header.time) {
    for (const TimeUnit& unit : kTimeUnits) {
      if (wanted == unit.name) {
        use(unit, "as the command line says");
      }
    }
    if (!wanted.empty() && unit_ == nullptr) {
      throw UsageError("unit of time: must be ns, us, ms or s (got '" + wanted + "')");
    }
    for (const TimeUnit& unit : kTimeUnits) {
      if (unit_ == nullptr && has_word(name_, unit.name)) {
        use(unit, "as the column's name says");
      }
    }
  }

  /// False when the text is not a time.
  /// @throws DataError naming `place` when the unit is ambiguous
  bool parse(std::string_view text, const std::string& place, std::int64_t& stamp_ns) {
    if (unit_ == nullptr && parse_date(text, stamp_ns)) {
      is_date_ = true;
      return true;
    }
    double number = 0.0;
    if (is_date_ || !text::parse_number(text, number) || !std::isfinite(number)) {
      return false;
    }
    if (unit_ == nullptr) {
      guess(number, place);
    }
    if (unit_ == &kTimeUnits.front()) {
      return text::parse_number(text, stamp_ns);
    }
    if (unit_ == &kTimeUnits.back() && text::parse_seconds(text, stamp_ns)) {
      return true;
    }
    const double ns = number * unit_->ns;
    if (!(std::abs(ns) < kMostNs)) {
      return false;
    }
    // Whole numbers stay integers: a double of nanoseconds since 1970 resolves 256 ns.
    stamp_ns = text::parse_number(text, stamp_ns) ? stamp_ns * static_cast<std::int64_t>(unit_->ns)
                                                  : static_cast<std::int64_t>(std::llround(ns));
    return true;
  }

  [[nodiscard]] std::string note() const {
    return "time is in column '" + name_ + "', " +
           (is_date_ ? std::string("dates as text, taken as UTC where they name no zone")
                     : "in " + std::string(unit_ == nullptr ? "ns" : unit_->name) + ", " + reason_);
  }

 private:
  void use(const TimeUnit& unit, const char* reason) {
    unit_ = &unit;
    reason_ = reason;
  }
  void guess(double number, const std::string& place) {
    constexpr double kYear2000S = 946'684'800.0;
    constexpr double kYear2100S = 4'102'444'800.0;
    for (const TimeUnit& unit : kTimeUnits) {
      const double seconds = number * unit.ns * 1e-9;
      if (seconds >= kYear2000S && seconds <= kYear2100S) {
        use(unit, "the only unit in which it is a date of this century");
        return;
      }
    }
    throw DataError(place + "the unit of time cannot be told from column '" + name_ +
                    "': say whether it is ns, us, ms or s");
  }

  std::string name_;
  const TimeUnit* unit_ = nullptr;
  const char* reason_ = "";
  bool is_date_ = false;
};

/// Rows in the order of the file, pressure in the file's unit.
struct RawLog {
  std::vector<PressureSample> rows;
  bool has_temperature = false;
  Tally broken;
  Tally out_of_order;
  std::string units_line;
};

std::string with_value(const text::CsvReader& csv, const std::string& rule, std::string_view value) {
  return csv.lines().place() + rule + " (is '" + std::string(value) + "')";
}

void read_rows(text::CsvReader& csv, TimeColumn& time, RawLog& log) {
  std::int64_t newest_ns = std::numeric_limits<std::int64_t>::min();
  std::size_t below_header = 0;
  for (auto row = csv.next(); row != text::CsvReader::Row::kEnd; row = csv.next()) {
    if (row == text::CsvReader::Row::kBad) {
      log.broken.add([&csv] { return csv.bad_row_message(); });
      continue;
    }
    PressureSample sample;
    const bool has_time = time.parse(csv.field(kTime), csv.lines().place(), sample.stamp_ns);
    const bool has_pressure =
        text::parse_number(csv.field(kPressure), sample.pressure_pa) && std::isfinite(sample.pressure_pa);
    if (!has_time && !has_pressure && log.rows.empty() && below_header < kLinesBelowHeader) {
      ++below_header;
      if (log.units_line.empty()) {
        log.units_line = csv.field(kPressure);
      }
    } else if (!has_time || implausible_stamp(sample.stamp_ns) != nullptr) {
      log.broken.add([&csv] { return with_value(csv, "has no time", csv.field(kTime)); });
    } else if (!has_pressure) {
      log.broken.add([&csv] { return with_value(csv, "has no pressure", csv.field(kPressure)); });
    } else if (sample.stamp_ns <= newest_ns) {
      log.out_of_order.add(
          [&csv] { return with_value(csv, "is not newer than rows before", csv.field(kTime)); });
    } else {
      if (!log.has_temperature || !text::parse_number(csv.field(kTemperature), sample.temperature_c)) {
        sample.temperature_c = kNone;
      }
      newest_ns = sample.stamp_ns;
      log.rows.push_back(sample);
    }
  }
}

double median_pressure(const std::vector<PressureSample>& rows) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const PressureSample& row : rows) {
    values.push_back(row.pressure_pa);
  }
  return median(std::move(values));
}

void keep_plausible(std::vector<PressureSample>& rows, PressureUnit unit, Tally& implausible) {
  std::erase_if(rows, [&](PressureSample& row) {
    row.pressure_pa *= pascals_per(unit);
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

}  // namespace

PressureLog read_pressure_log(const std::filesystem::path& file, const PressureColumns& columns) {
  const PressureHeader header = find_pressure_header(file, columns);
  std::vector<std::string_view> optional;
  if (!header.temperature.empty()) {
    optional.emplace_back(header.temperature);
  }
  text::CsvReader csv(text::TextLines(file), {header.time, header.pressure}, optional, header.format);
  TimeColumn time(header, columns.time_unit);
  RawLog raw;
  raw.has_temperature = !optional.empty();
  read_rows(csv, time, raw);
  PressureLog log;
  log.file = file.string();
  log.has_temperature = !header.temperature.empty();
  if (raw.rows.empty()) {
    throw DataError(raw.broken.count == 0 ? log.file + ":" + std::to_string(csv.lines().line_number()) +
                                                ": has no row below the line that names the columns"
                                          : raw.broken.first_message + "; none of " +
                                                std::to_string(raw.broken.count) + " rows can be used");
  }
  const UnitFinding unit = find_unit(
      {columns.pressure_unit, header.pressure, raw.units_line, median_pressure(raw.rows)}, log.file + ": ");
  log.notes.push_back("pressure is in " + std::string(kPressureUnitNames.name(unit.unit)) + " (column '" +
                      header.pressure + "', " + unit.reason + ")");
  log.notes.push_back(time.note());
  if (log.has_temperature) {
    log.notes.push_back("temperature is in degC (column '" + header.temperature + "')");
  }
  Tally implausible;
  keep_plausible(raw.rows, unit.unit, implausible);
  if (raw.rows.empty()) {
    throw DataError(log.file + ": " + implausible.first_message + ": none of " +
                    std::to_string(implausible.count) + " rows can be used");
  }
  add_count(raw.broken, "rows left out that are no numbers: ", log);
  add_count(raw.out_of_order, "rows left out whose time goes back: ", log);
  add_count(implausible, "rows left out that are implausible: ", log);
  log.samples = std::move(raw.rows);
  return log;
}

}  // namespace isobar::recording
