// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/date_text.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>

#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

constexpr std::int64_t kDayNs = 86'400'000'000'000;

/// Removes exactly `digits` digits from the front.
bool take_digits(std::string_view& text, std::size_t digits, int& value) {
  if (text.size() < digits) {
    return false;
  }
  value = 0;
  for (std::size_t k = 0; k < digits; ++k) {
    if (text[k] < '0' || text[k] > '9') {
      return false;
    }
    value = 10 * value + (text[k] - '0');
  }
  text.remove_prefix(digits);
  return true;
}

bool take(std::string_view& text, char expected) {
  if (!text.starts_with(expected)) {
    return false;
  }
  text.remove_prefix(1);
  return true;
}

/// Removes one or two digits from the front.
bool take_one_or_two(std::string_view& text, int& value) {
  const bool two = text.size() > 1 && text[1] >= '0' && text[1] <= '9';
  return take_digits(text, two ? 2 : 1, value);
}

/// With `american`, "m/d/yyyy" as well: only beside AM or PM is that no day before a month.
bool take_day(std::string_view& text, bool american, std::int64_t& days) {
  int year = 0;
  int month = 0;
  int day = 0;
  const std::string_view whole = text;
  const bool month_first = american && take_one_or_two(text, month) && take(text, '/') &&
                           take_one_or_two(text, day) && take(text, '/') && take_digits(text, 4, year);
  if (!month_first) text = whole;
  const char separator = text.size() > 4 ? text[4] : '-';
  const bool year_first = separator == '-' || separator == '/';
  const bool parsed =
      month_first  ? true
      : year_first ? take_digits(text, 4, year) && take(text, separator) && take_digits(text, 2, month) &&
                         take(text, separator) && take_digits(text, 2, day)
                   : take_digits(text, 2, day) && take(text, '.') && take_digits(text, 2, month) &&
                         take(text, '.') && take_digits(text, 4, year);
  if (!parsed) return false;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  days = date.ok() ? std::chrono::sys_days(date).time_since_epoch().count() : 0;
  // int64 nanoseconds hold 1677 to 2262.
  return date.ok() && year >= 1700 && year < 2250;
}

/// ":ss" and decimals, both optional.
bool take_seconds(std::string_view& text, std::int64_t& ns) {
  ns = 0;
  if (!take(text, ':')) {
    return true;
  }
  std::size_t length = text.find_first_not_of("0123456789.,");
  length = length == std::string_view::npos ? text.size() : length;
  std::string digits(text.substr(0, length));
  std::replace(digits.begin(), digits.end(), ',', '.');
  constexpr std::int64_t kNsPerMinute = 60'000'000'000;
  const bool fits = length >= 2 && text::parse_seconds(digits, ns) && ns < kNsPerMinute;
  text.remove_prefix(length);
  return fits;
}

enum class HalfDay : std::uint8_t { kNone, kAm, kPm };

/// Removes AM or PM from the end.
HalfDay take_half_day(std::string_view& text) {
  constexpr std::array<std::pair<std::string_view, HalfDay>, 4> kEnds{
      {{"AM", HalfDay::kAm}, {"am", HalfDay::kAm}, {"PM", HalfDay::kPm}, {"pm", HalfDay::kPm}}};
  for (const auto& [end, half] : kEnds) {
    if (!text.ends_with(end)) continue;
    text.remove_suffix(end.size());
    text = text::trimmed(text);
    return half;
  }
  return HalfDay::kNone;
}

/// 12:30 AM is half past midnight, 12:30 PM half past noon.
bool to_whole_day(HalfDay half, std::int64_t& of_day_ns) {
  if (half == HalfDay::kNone) return true;
  if (of_day_ns < kDayNs / 24 || of_day_ns >= kDayNs / 24 * 13) return false;  // a clock of 1 to 12 hours
  of_day_ns = of_day_ns % (kDayNs / 2) + (half == HalfDay::kPm ? kDayNs / 2 : 0);
  return true;
}

/// "h:mm" or "hh:mm", seconds optional; 24:00 is the end of a day, and nothing follows it (ISO 8601).
bool take_time(std::string_view& text, std::int64_t& of_day_ns) {
  int hour = 0;
  int minute = 0;
  std::int64_t seconds_ns = 0;
  const std::size_t digits = text.size() > 1 && text[1] == ':' ? 1 : 2;
  if (!take_digits(text, digits, hour) || !take(text, ':') || !take_digits(text, 2, minute) ||
      !take_seconds(text, seconds_ns)) {
    return false;
  }
  of_day_ns = (std::int64_t{hour} * 60 + minute) * 60 * 1'000'000'000 + seconds_ns;
  return hour <= 24 && minute <= 59 && of_day_ns <= kDayNs;
}

bool take_zone(std::string_view& text, std::int64_t& minutes) {
  minutes = 0;
  if (text.empty() || take(text, 'Z')) {
    return true;
  }
  const bool east = text.front() == '+';
  if (!east && text.front() != '-') {
    return false;
  }
  text.remove_prefix(1);
  int hour = 0;
  int minute = 0;
  if (!take_digits(text, 2, hour)) {
    return false;
  }
  take(text, ':');
  if (!text.empty() && !take_digits(text, 2, minute)) {
    return false;
  }
  minutes = 60 * std::int64_t{hour} + minute;
  minutes = east ? minutes : -minutes;
  return hour < 24 && minute < 60;
}

}  // namespace

bool parse_date(std::string_view text, std::int64_t& stamp_ns) {
  text = text::trimmed(text);
  std::int64_t days = 0;
  std::int64_t of_day_ns = 0;
  std::int64_t zone_minutes = 0;
  const HalfDay half = take_half_day(text);
  if (!take_day(text, half != HalfDay::kNone, days) || (!take(text, ' ') && !take(text, 'T')) ||
      !take_time(text, of_day_ns) || !take_zone(text, zone_minutes) || !text.empty() ||
      !to_whole_day(half, of_day_ns)) {
    return false;
  }
  stamp_ns = (days * 24 * 60 - zone_minutes) * 60 * 1'000'000'000 + of_day_ns;
  return true;
}

bool parse_time_of_day(std::string_view text, std::int64_t& of_day_ns) {
  text = text::trimmed(text);
  const HalfDay half = take_half_day(text);
  return take_time(text, of_day_ns) && text.empty() && to_whole_day(half, of_day_ns);
}

}  // namespace isobar::recording
