// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/errors.hpp"
#include "run/recording/date_text.hpp"
#include "run/recording/pressure_log.hpp"
#include "run/recording/pressure_unit.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_pressure_log {

using namespace isobar::recording;
using isobar::test::Scratch;

namespace {

PressureLog log_of(const std::string& text, const PressureColumns& columns = {}) {
  const Scratch scratch;
  scratch.write("log.csv", text);
  return read_pressure_log(scratch.path() / "log.csv", columns);
}

std::string error_of(const std::string& text, const PressureColumns& columns = {}) {
  try {
    log_of(text, columns);
  } catch (const DataError& error) {
    return error.what();
  }
  return {};
}

bool says(const PressureLog& log, const std::string& words) {
  for (const std::string& note : log.notes) {
    if (note.find(words) != std::string::npos) {
      return true;
    }
  }
  return false;
}

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("A recording's barometer is read to the bit") {
  const PressureLog log = log_of(
      "t_ns,pressure_pa,temperature_c\n1586000000123456789,98712.3456,21.5\n1586000000223456789,98712.5,\n");
  REQUIRE(log.samples.size() == 2);
  CHECK(log.samples[0].stamp_ns == 1'586'000'000'123'456'789);
  CHECK(log.samples[0].pressure_pa == 98'712.3456);
  CHECK(log.samples[0].temperature_c == 21.5);
  CHECK(std::isnan(log.samples[1].temperature_c));
  CHECK(says(log, "pressure is in Pa (column 'pressure_pa', as the column's name says)"));
  CHECK(says(log, "in ns, as the column's name says"));
}

TEST_CASE("A data logger's file with lines around the header, quotes and hPa is understood") {
  const PressureLog log = log_of(
      "\"TOA5\",\"STATION\",\"CR1000X\"\r\n\"TIMESTAMP\",\"RECORD\",\"P_Avg\"\r\n\"TS\",\"RN\",\"hPa\"\r\n"
      "\"\",\"\",\"Avg\"\r\n\"2020-04-04 00:00:00\",62513,986.5\r\n\"2020-04-04 00:01:00\",62514,986.25\r\n");
  REQUIRE(log.samples.size() == 2);
  CHECK(log.samples[1].pressure_pa == doctest::Approx(98'625.0));
  CHECK(log.samples[1].stamp_ns - log.samples[0].stamp_ns == 60'000'000'000);
  CHECK_FALSE(log.has_temperature);
  CHECK(says(log, "pressure is in hPa (column 'P_Avg', as the line of units says)"));
}

TEST_CASE("Semicolons and tabs separate fields, too; columns are named by the user or recognised") {
  CHECK(log_of("Time;p_mbar;Temp\n1586000000;985.5;20\n").samples[0].pressure_pa ==
        doctest::Approx(98'550.0));
  CHECK(log_of("Time\tp_kPa\tTemp\n1586000000\t98.55\t20\n").samples[0].pressure_pa ==
        doctest::Approx(98'550.0));
  PressureColumns second;
  second.pressure = "2_P";
  second.temperature = "2_Ta";
  const PressureLog log = log_of("Time,1_P,1_Ta,2_P,2_Ta\n1586000000,1,2,985.5,4\n", second);
  CHECK(log.samples[0].pressure_pa == doctest::Approx(98'550.0));
  CHECK(log.samples[0].temperature_c == 4.0);
  CHECK(says(log, "the only unit in which its median, 985.5, is an air pressure"));
}

TEST_CASE("An ambiguous column is an error that lists the candidates") {
  const std::string two = error_of("Time,1_P,2_P,Ta\n1586000000,985.5,986,20\n");
  CHECK(contains(two, "log.csv:1: '1_P', '2_P' could all be the pressure: name one of them"));
  CHECK(contains(error_of("Time,P,in_temp,out_temp\n1586000000,985.5,986,20\n"),
                 "'in_temp', 'out_temp' could all be the temperature"));
  PressureColumns reference;
  reference.needs_temperature = false;
  CHECK(error_of("Time,P,in_temp,out_temp\n1586000000,985.5,986,20\n", reference).empty());
}

TEST_CASE("Missing columns, headers and rows, and empty files are named in the error") {
  PressureColumns named;
  named.pressure = "P_mbar";
  CHECK(contains(error_of("Time,Pressure,Ta\n1586000000,985.5,20\n", named),
                 "log.csv:1: column 'P_mbar' is missing; the columns are 'Time', 'Pressure', 'Ta'"));
  CHECK(contains(error_of("Time,Height\n1,2\n"), "log.csv:1: no column looks like the pressure"));
  CHECK(contains(error_of(""), "log.csv:1: is empty"));
  CHECK(contains(error_of("hello\n"), "log.csv:1: must name columns separated by"));
  CHECK(contains(error_of("Time,P,Ta\n"), "has no row below the line that names the columns"));
  CHECK_THROWS_AS(read_pressure_log("/nonexistent.csv", {}), DataError);
}

TEST_CASE("Rows that are not numbers, implausible, torn or older than the newest are skipped and counted") {
  const PressureLog log = log_of(
      "t_s,p_hPa,temp\n100,985,20\n101,nan,20\n102,,20\n103,985,20,7\n104,9850,20\n105,985,20\n105,985,20\n"
      "99,985,20\nnan,985,20\n106,985,20\n");
  CHECK(log.samples.size() == 4);  // the repeated second is spread
  CHECK(says(log, "no numbers: 4 (first: "));
  CHECK(says(log, "log.csv:3: has no pressure (is 'nan')"));
  CHECK(says(log, "goes back, while the rows after them go on: 1"));
  CHECK(says(log, "implausible: 1 (first: pressure must lie within"));
  CHECK(contains(error_of("t_s,p_hPa,temp\n1,nan,20\n2,nan,20\n"), "none of 2 rows can be used"));
  CHECK(contains(error_of("t_s,p_hPa,temp\n1,985,293\n2,985,294\n"), "temperature must lie within"));
}

TEST_CASE("Units that contradict the values or each other, and unknown units, are errors, never a guess") {
  CHECK(contains(
      error_of("t_s,pressure_pa\n1,985\n"),
      "pressure is in Pa, as the column's name says, but its median, 985 Pa, is not an air pressure"));
  CHECK(contains(error_of("t_s,p\n1,29.9\n"), "the unit of pressure is unknown: its median, 29.9"));
  CHECK(contains(error_of("t_s,p_hPa_kPa\n1,98\n"), "more than one unit"));
  PressureColumns chosen;
  chosen.pressure_unit = "kPa";
  CHECK(contains(error_of("t_s,p\n1,985\n", chosen), "as the command line says, but"));
  CHECK(log_of("t_s,p\n1,98.5\n", chosen).samples[0].pressure_pa == doctest::Approx(98'500.0));
  chosen.pressure_unit = "fathom";
  CHECK_THROWS_AS(log_of("t_s,p\n1,14.5\n", chosen), UsageError);
  CHECK(unit_of_word("MBAR") == PressureUnit::kHectopascal);
  CHECK_FALSE(unit_of_word("dbar").has_value());
}

TEST_CASE("Time is a date, or a number whose unit is named or gives a date of this century") {
  const auto stamp = [](const std::string& time, const std::string& name = "time") {
    return log_of(name + ",p\n" + time + ",985\n").samples[0].stamp_ns;
  };
  CHECK(stamp("1586000000.25") == 1'586'000'000'250'000'000);
  CHECK(stamp("1586000000250") == 1'586'000'000'250'000'000);
  CHECK(stamp("1586000000250000") == 1'586'000'000'250'000'000);
  CHECK(stamp("1586000000250000001") == 1'586'000'000'250'000'001);
  CHECK(stamp("12.5", "time_ms") == 12'500'000);
  CHECK(stamp("2020-04-04T11:33:20.25Z") == 1'586'000'000'250'000'000);
  CHECK(contains(error_of("time,p\n12.5,985\n"),
                 "log.csv:2: the unit of time cannot be told from column 'time'"));
  PressureColumns named;
  named.time_unit = "hours";
  CHECK_THROWS_AS(log_of("time,p\n12.5,985\n", named), UsageError);
}

TEST_CASE("Only existing dates are accepted, with their zone") {
  const auto ns = [](const char* text) {
    std::int64_t stamp_ns = -1;
    return parse_date(text, stamp_ns) ? stamp_ns : -1;
  };
  CHECK(ns("1970-01-02 00:00") == 86'400'000'000'000);
  CHECK(ns("\"1970-01-01 00:00:01\"") == 1'000'000'000);
  CHECK(ns("1970-01-01 24:00") == 86'400'000'000'000);
  CHECK(ns("1970-01-01T02:00:00+02:00") == 0);
  CHECK(ns("1970-01-01T00:00:00-0130") == 5'400'000'000'000);
  CHECK(ns("2020-02-29 12:00:00") == 1'582'977'600'000'000'000);
  for (const char* bad :
       {"2019-02-29 12:00:00", "2020-13-01 00:00", "2020-01-01", "2020-01-01 10", "20-01-01 10:00",
        "2020-01-01 10:61", "2020-01-01 10:00:75", "2020-01-01 10:00x", "12:00:00", "", "9999-01-01 00:00",
        "2020-01-01 10:00:00+25:00", "2020-01-01 24:01", "2020-01-01 24:00:00.5"}) {
    CAPTURE(bad);
    CHECK(ns(bad) == -1);
  }
}

}  // namespace isobar::test::test_pressure_log
