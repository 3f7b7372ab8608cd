// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/time_column.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/errors.hpp"
#include "run/recording/date_text.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

// Largest time, below 2^63.
constexpr double kMostNs = 9.2e18;
constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr std::int64_t kNsPerDay = 86'400 * kNsPerS;
constexpr std::array<TimeUnit, 6> kTimeUnits = {
    {{"ns", 1.0}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}, {"min", 60e9}, {"h", 3600e9}}};
constexpr const TimeUnit* kNanosecond = kTimeUnits.data();
constexpr const TimeUnit* kSecond = &kTimeUnits[3];

struct UnitWord {
  const char* word;
  const char* unit;
};
/// Words of a column's name that name its unit, besides the units themselves.
constexpr std::array<UnitWord, 17> kUnitWords = {{{"nanoseconds", "ns"},
                                                  {"nanosec", "ns"},
                                                  {"nsec", "ns"},
                                                  {"nanos", "ns"},
                                                  {"microseconds", "us"},
                                                  {"microsec", "us"},
                                                  {"usec", "us"},
                                                  {"micros", "us"},
                                                  {"milliseconds", "ms"},
                                                  {"millisec", "ms"},
                                                  {"msec", "ms"},
                                                  {"millis", "ms"},
                                                  {"seconds", "s"},
                                                  {"sec", "s"},
                                                  {"secs", "s"},
                                                  {"minutes", "min"},
                                                  {"hours", "h"}}};

/// Whether a column's name says that its times are in this unit.
bool says_unit(std::string_view column, std::string_view unit) {
  return has_word(column, unit) ||
         std::any_of(kUnitWords.begin(), kUnitWords.end(), [&](const UnitWord& known) {
           return unit == known.unit && has_word(column, known.word);
         });
}

}  // namespace

std::string with_decimal_point(std::string_view text) {
  std::string number(text);
  const std::size_t comma = number.find(',');
  if (comma == std::string::npos || number.find(',', comma + 1) != std::string::npos) return number;
  if (number.find('.', comma) != std::string::npos) return number;
  number[comma] = '.';
  // Points before the comma group thousands.
  const auto groups = std::remove(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(comma), '.');
  number.erase(groups, number.begin() + static_cast<std::ptrdiff_t>(comma));
  return number;
}

TimeColumn::TimeColumn(const PressureHeader& header, const std::string& unit)
    : name_(header.time), rest_name_(header.time_rest), layout_(header.time_layout) {
  for (const TimeUnit& known : kTimeUnits) {
    if (unit == known.name) {
      use(known, "as the command line says");
      unit_is_chosen_ = true;
    }
  }
  if (!unit.empty() && unit_ == nullptr) {
    throw UsageError("unit of time: must be ns, us, ms, s, min or h (got '" + unit + "')");
  }
  for (const TimeUnit& known : kTimeUnits) {
    if (unit_ == nullptr && says_unit(name_, known.name)) {
      use(known, "as the column's name says");
    }
  }
}

bool TimeColumn::parse(std::string_view text, std::string_view rest, const std::string& place,
                       std::int64_t& stamp_ns) {
  if (layout_ == TimeLayout::kDateAndTime) {
    is_date_ = true;
    const std::string both = std::string(text::trimmed(text)) + " " + std::string(text::trimmed(rest));
    return parse_date(both, stamp_ns);
  }
  if (layout_ != TimeLayout::kOneColumn) return parse_pair(text, rest, stamp_ns);
  // "time (h:m:s)": letters that are units of numbers as well.
  const bool may_be_text = unit_ == nullptr || (!unit_is_chosen_ && text.find(':') != std::string_view::npos);
  if (may_be_text && parse_text(text, stamp_ns)) return true;
  return !is_date_ && !is_time_of_day_ && parse_number(with_decimal_point(text), place, stamp_ns);
}

bool TimeColumn::parse_pair(std::string_view text, std::string_view rest, std::int64_t& stamp_ns) {
  const std::int64_t per_s = layout_ == TimeLayout::kSecondsAndNanoseconds ? kNsPerS : 1'000'000;
  constexpr std::int64_t kMostS = 9'000'000'000;
  std::int64_t seconds = 0;
  std::int64_t below = 0;
  if (!text::parse_number(text, seconds) || !text::parse_number(rest, below) || seconds < 0 ||
      seconds > kMostS || below < 0 || below >= per_s) {
    return false;
  }
  stamp_ns = seconds * kNsPerS + below * (kNsPerS / per_s);
  return true;
}

bool TimeColumn::parse_text(std::string_view text, std::int64_t& stamp_ns) {
  if (!is_time_of_day_ && parse_date(text, stamp_ns)) {
    is_date_ = true;
    return true;
  }
  std::int64_t of_day_ns = 0;
  if (is_date_ || !parse_time_of_day(text, of_day_ns)) return false;
  stamp_ns = on_its_day(of_day_ns);
  return true;
}

/// A time of day earlier by more than half a day is of the day after. One that is later by nearly a day came late, from
/// before midnight.
std::int64_t TimeColumn::on_its_day(std::int64_t of_day_ns) {
  const std::int64_t step_ns = is_time_of_day_ ? of_day_ns - last_of_day_ns_ : 0;
  is_time_of_day_ = true;
  if (day_ > 0 && step_ns > kNsPerDay * 23 / 24) return (day_ - 1) * kNsPerDay + of_day_ns;
  if (step_ns < -kNsPerDay / 2) ++day_;
  last_of_day_ns_ = of_day_ns;
  return day_ * kNsPerDay + of_day_ns;
}

bool TimeColumn::parse_number(const std::string& text, const std::string& place, std::int64_t& stamp_ns) {
  double number = 0.0;
  if (!text::parse_number(text, number) || !std::isfinite(number)) {
    return false;
  }
  if (unit_ == nullptr) {
    guess(number, place);
  }
  if (unit_ == kNanosecond) {
    return text::parse_number(text, stamp_ns);
  }
  if (unit_ == kSecond && text::parse_seconds(text, stamp_ns)) {
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

std::string TimeColumn::note() const {
  const std::string columns = rest_name_.empty()
                                  ? "time is in column '" + name_ + "', "
                                  : "time is in columns '" + name_ + "' and '" + rest_name_ + "', ";
  if (layout_ == TimeLayout::kSecondsAndNanoseconds) return columns + "in s and ns";
  if (layout_ == TimeLayout::kSecondsAndMicroseconds) return columns + "in s and us";
  if (is_date_) return columns + "dates as text, taken as UTC where they name no zone";
  if (is_time_of_day_) return columns + "the time of day; its first day is taken as 1970-01-01";
  return columns + "in " + (unit_ == nullptr ? "ns" : unit_->name) + ", " + reason_;
}

void TimeColumn::use(const TimeUnit& unit, const char* reason) {
  unit_ = &unit;
  reason_ = reason;
}

void TimeColumn::guess(double number, const std::string& place) {
  constexpr double kYear2000S = 946'684'800.0;
  constexpr double kYear2100S = 4'102'444'800.0;
  for (const TimeUnit& unit : kTimeUnits) {
    if (&unit > kSecond) break;  // nobody counts minutes or hours from 1970
    const double seconds = number * unit.ns * 1e-9;
    if (seconds >= kYear2000S && seconds <= kYear2100S) {
      use(unit, "the only unit in which it is a date of this century");
      return;
    }
  }
  throw DataError(place + "the unit of time cannot be told from column '" + name_ +
                  "': say whether it is ns, us, ms, s, min or h");
}

}  // namespace isobar::recording
