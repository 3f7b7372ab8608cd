// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/date_text.hpp"

#include <chrono>

#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

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

bool take_day(std::string_view& text, std::int64_t& days) {
  int year = 0;
  int month = 0;
  int day = 0;
  if (!take_digits(text, 4, year) || !take(text, '-') || !take_digits(text, 2, month) || !take(text, '-') ||
      !take_digits(text, 2, day)) {
    return false;
  }
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
  std::size_t length = text.find_first_not_of("0123456789.");
  length = length == std::string_view::npos ? text.size() : length;
  constexpr std::int64_t kNsPerMinute = 60'000'000'000;
  const bool fits = length >= 2 && text::parse_seconds(text.substr(0, length), ns) && ns < kNsPerMinute;
  text.remove_prefix(length);
  return fits;
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
  std::int64_t seconds_ns = 0;
  std::int64_t zone_minutes = 0;
  int hour = 0;
  int minute = 0;
  if (!take_day(text, days) || (!take(text, ' ') && !take(text, 'T')) || !take_digits(text, 2, hour) ||
      !take(text, ':') || !take_digits(text, 2, minute) || !take_seconds(text, seconds_ns) ||
      !take_zone(text, zone_minutes) || !text.empty() || hour > 24 || minute > 59) {
    return false;
  }
  if (hour == 24 && (minute > 0 || seconds_ns > 0)) {
    return false;  // ISO 8601: 24:00 is the end of a day, and nothing follows it
  }
  const std::int64_t minutes = (days * 24 + hour) * 60 + minute - zone_minutes;
  stamp_ns = minutes * 60 * 1'000'000'000 + seconds_ns;
  return true;
}

}  // namespace isobar::recording
