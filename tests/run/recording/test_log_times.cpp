// SPDX-License-Identifier: BSD-3-Clause
// Times of pressure logs as people have them: coarse, in two columns, set back.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/pressure_log.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_log_times {

using namespace isobar::recording;
using isobar::test::Scratch;

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kRowNs = kSecondNs / 32;
constexpr int kRows = 1'920;  // a minute at 32 Hz

PressureLog log_of(const std::string& text, const PressureColumns& columns = {}) {
  const Scratch scratch;
  scratch.write("log.csv", text);
  return read_pressure_log(scratch.path() / "log.csv", columns);
}

/// Rows of a minute; each has its index as its pressure [Pa] above 100 kPa.
std::string rows(const std::function<std::string(std::int64_t)>& time, std::int64_t first_ns,
                 const char* separator = ",") {
  std::string text;
  for (int i = 0; i < kRows; ++i) {
    text += time(first_ns + i * kRowNs) + separator + std::to_string(100'000 + i) + "\n";
  }
  return text;
}

/// Time of day with decimals: "22:13:20.031".
std::string clock_text(std::int64_t ns, int decimals, char point = '.') {
  char text[40];  // NOLINT(modernize-avoid-c-arrays)
  const std::int64_t of_day = ns / kSecondNs % 86'400;
  std::snprintf(text, sizeof text, "%02d:%02d:%02d%c%03d", static_cast<int>(of_day / 3600),
                static_cast<int>(of_day / 60 % 60), static_cast<int>(of_day % 60), point,
                static_cast<int>(ns / 1'000'000 % 1000));
  return std::string(text).substr(0, decimals == 0 ? 8 : std::string::npos);
}

/// Every row is there, and each is as long after the first as it was; within `tolerance_ns`.
void check_rows(const PressureLog& log, std::int64_t tolerance_ns) {
  REQUIRE(log.samples.size() == kRows);
  std::int64_t largest_ns = 0;
  for (int i = 0; i < kRows; ++i) {
    const PressureSample& sample = log.samples[static_cast<std::size_t>(i)];
    REQUIRE(sample.pressure_pa == 100'000.0 + i);
    const std::int64_t error_ns = sample.stamp_ns - log.samples[0].stamp_ns - i * kRowNs;
    largest_ns = std::max(largest_ns, std::abs(error_ns));
  }
  CHECK(largest_ns <= tolerance_ns);
}

bool says(const PressureLog& log, const std::string& words) {
  for (const std::string& note : log.notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

constexpr std::int64_t kMorningNs = 8 * 3'600 * kSecondNs;
constexpr std::int64_t kMillisecondNs = 1'000'000;  // the texts have milliseconds

}  // namespace

TEST_CASE("rows of one second are spread over it, also in the seconds in which the log begins and ends") {
  for (const std::int64_t first_ns : {kMorningNs, kMorningNs + kSecondNs / 2}) {
    const PressureLog log =
        log_of("Time,Pressure (Pa)\n" +
               rows([](std::int64_t ns) { return "2023-11-14 " + clock_text(ns, 0); }, first_ns));
    check_rows(log, 1'000);
    CHECK(says(log, "rows spread over the 1 s that the clock shows"));
    CHECK(log.samples[0].stamp_ns % (86'400 * kSecondNs) == first_ns);
  }
}

TEST_CASE("repeated times of a fine clock are counted apart from times that go back") {
  const PressureLog log =
      log_of("t_s,p_hPa\n100.001,985\n100.012,985\n100.012,985\n100.023,985\n100.005,985\n100.034,985\n");
  CHECK(log.samples.size() == 4);
  CHECK(says(log, "repeat the time of the row before: 1"));
  CHECK(says(log, "goes back, while the rows after them go on: 1"));
}

TEST_CASE("seconds and nanoseconds in two columns are one time, found or named") {
  const std::string text = "header.stamp.sec,header.stamp.nanosec,fluid_pressure\n" +
                           rows(
                               [](std::int64_t ns) {
                                 return std::to_string(ns / kSecondNs) + "," + std::to_string(ns % kSecondNs);
                               },
                               1'700'000'000 * kSecondNs);
  check_rows(log_of(text), 0);
  PressureColumns named;
  named.time = "header.stamp.sec";
  named.time_unit = "s";
  named.pressure = "fluid_pressure";
  named.needs_temperature = false;
  check_rows(log_of(text, named), 0);
  CHECK(says(log_of(text), "in columns 'header.stamp.sec' and 'header.stamp.nanosec', in s and ns"));
}

TEST_CASE("date and time in two columns are one time, with decimal commas where semicolons separate") {
  const auto with = [](const char* date, char separator, char point) {
    return [=](std::int64_t ns) { return date + std::string(1, separator) + clock_text(ns, 3, point); };
  };
  check_rows(log_of("Date,Time,Pressure (Pa)\n" + rows(with("2023-11-14", ',', '.'), kMorningNs)),
             kMillisecondNs);
  check_rows(log_of("Date,Time,Pressure (Pa)\n" + rows(with("2023/11/14", ',', '.'), kMorningNs)),
             kMillisecondNs);
  const PressureLog german =
      log_of("Datum;Uhrzeit;Luftdruck (Pa)\n" + rows(with("14.11.2023", ';', ','), kMorningNs, ";"));
  check_rows(german, kMillisecondNs);
  CHECK(german.samples[0].stamp_ns == 1'699'948'800 * kSecondNs);
  CHECK(log_of("Time;p_hPa;Temp\n1586000000,25;985,5;20,5\n").samples[0].stamp_ns ==
        1'586'000'000'250'000'000);
  CHECK(log_of("Time;p_hPa;Temp\n1586000000,25;1.013,25;20,5\n").samples[0].pressure_pa ==
        doctest::Approx(101'325.0));
  CHECK(log_of("Time;p_hPa;Temp\n1586000000,25;985,5;20,5\n").samples[0].temperature_c == 20.5);
}

TEST_CASE(
    "a clock of twice twelve hours, with the month first as its loggers write it, is a clock of a day") {
  const auto time_of = [](const char* text) {
    return log_of("Time,Pressure (Pa)\n" + std::string(text) + ",100000\n").samples.at(0).stamp_ns /
           kSecondNs;
  };
  constexpr std::int64_t kDayS = 1'699'920'000;  // 2023-11-14
  CHECK(time_of("11/14/2023 10:13:20 PM") == kDayS + 22 * 3'600 + 13 * 60 + 20);
  CHECK(time_of("11/14/2023 12:30:00 AM") == kDayS + 30 * 60);
  CHECK(time_of("11/14/2023 12:30:00 pm") == kDayS + 12 * 3'600 + 30 * 60);
  CHECK(time_of("1/5/2024 9:05 AM") == 1'704'412'800 + 9 * 3'600 + 5 * 60);
  CHECK(time_of("2023-11-14 1:00:00 PM") == kDayS + 13 * 3'600);
  CHECK(time_of("10:13:20 PM") == 22 * 3'600 + 13 * 60 + 20);
  for (const char* no_time : {"11/14/2023 13:00:00 PM", "11/14/2023 0:30:00 AM", "11/14/2023 22:13:20"}) {
    CAPTURE(no_time);  // no hours of such a clock; and without AM or PM, 11/12 may be in November or December
    CHECK_THROWS_AS(time_of(no_time), DataError);
  }
}

TEST_CASE("the unit of a counted time is read from the words of loggers") {
  const auto second_ns = [](const std::string& column, const char* second_row) {
    const PressureLog log = log_of(column + ",p_Pa\n0,100000\n" + second_row + ",100001\n");
    return log.samples.at(1).stamp_ns - log.samples.at(0).stamp_ns;
  };
  CHECK(second_ns("millis", "31") == 31 * kMillisecondNs);
  CHECK(second_ns("micros", "31250") == kRowNs);
  CHECK(second_ns("seconds", "0.03125") == kRowNs);
  CHECK(second_ns("elapsed (min)", "0.5") == 30 * kSecondNs);
  CHECK(second_ns("hours", "0.25") == 900 * kSecondNs);
  CHECK_THROWS_WITH_AS(second_ns("elapsed", "1"), doctest::Contains("the unit of time cannot be told"),
                       DataError);
  const PressureLog letters = log_of("time (h:m:s),p_Pa\n08:00:00.25,100000\n08:00:01.5,100001\n");
  CHECK(letters.samples.at(1).stamp_ns - letters.samples.at(0).stamp_ns == 1'250 * kMillisecondNs);
}

TEST_CASE("a decimal comma between quotation marks is one, where commas separate fields") {
  const PressureLog log = log_of("\"t_s\",\"p_hPa\",\"Temp (C)\"\n\"100,25\",\"1.013,25\",\"20,5\"\n");
  CHECK(log.samples.at(0).stamp_ns == 100'250'000'000);
  CHECK(log.samples.at(0).pressure_pa == doctest::Approx(101'325.0));
  CHECK(log.samples.at(0).temperature_c == 20.5);
}

TEST_CASE("a time of day alone goes on across midnight") {
  const PressureLog log =
      log_of("Time,Pressure (Pa)\n" +
             rows([](std::int64_t ns) { return clock_text(ns, 3); }, (86'400 - 30) * kSecondNs));
  check_rows(log, kMillisecondNs);
  CHECK(says(log, "the time of day; its first day is taken as 1970-01-01"));
}

TEST_CASE("a clock that is set back goes on as a new piece, by half a second or by an hour, coarse or fine") {
  for (const double step_s : {0.5, 1.0, 3'600.0, 90'000.0}) {
    for (const int decimals : {0, 3}) {
      if (decimals == 0 && step_s < 2.0)
        continue;  // within two of its seconds, a coarse clock does not show it
      CAPTURE(step_s);
      CAPTURE(decimals);
      const std::int64_t first_ns = 2 * 86'400 * kSecondNs + kMorningNs;
      const PressureLog log = log_of("Time,Pressure (Pa)\n" +
                                     rows(
                                         [&](std::int64_t ns) {
                                           const std::int64_t after_ns = ns - first_ns;
                                           if (after_ns >= 30 * kSecondNs) ns -= std::llround(step_s * 1e9);
                                           return "2023-11-1" + std::to_string(ns / kSecondNs / 86'400 + 1) +
                                                  " " + clock_text(ns, decimals);
                                         },
                                         first_ns));
      // The step is known to one interval of the rows.
      check_rows(log, kRowNs);
      CHECK(says(log, "log.csv:962: the clock was set back by"));
    }
  }
}

TEST_CASE("a single time far ahead costs its row only, and late rows are dropped") {
  std::string text = "t_s,p_Pa\n";
  for (int i = 0; i < 40; ++i) {
    text += std::to_string(100 + i) + ".25,100000\n";
    if (i == 20) text += "4000000000,100000\n";
    if (i == 30) text += "110.5,100000\n111.5,100000\n";
  }
  const PressureLog log = log_of(text);
  CHECK(log.samples.size() == 40);
  CHECK(log.samples.back().stamp_ns == 139'250'000'000);
  CHECK_FALSE(says(log, "set back"));
}

}  // namespace isobar::test::test_log_times
