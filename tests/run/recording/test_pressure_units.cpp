// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/pressure_log.hpp"
#include "run/recording/pressure_unit.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_pressure_units {

using namespace isobar::recording;
using isobar::test::Scratch;

namespace {

PressureLog log_of(const std::string& text, const PressureColumns& columns = {}) {
  const Scratch scratch;
  scratch.write("log.csv", text);
  return read_pressure_log(scratch.path() / "log.csv", columns);
}

double pressure_of(const std::string& column, const std::string& value) {
  return log_of("t_s," + column + "\n1," + value + "\n").samples[0].pressure_pa;
}

double temperature_of(const std::string& column, const std::string& value) {
  return log_of("t_s,p_Pa," + column + "\n1,101325," + value + "\n").samples[0].temperature_c;
}

std::string error_of(const std::string& column, const std::string& value) {
  try {
    pressure_of(column, value);
  } catch (const DataError& error) {
    return error.what();
  }
  return {};
}

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("every unit of pressure that a header names is converted, however it is written") {
  // One standard atmosphere. Conversion factors of seven digits: within 0.1 Pa.
  const std::vector<std::pair<std::string, std::string>> columns{{"pressure_mmHg", "760"},
                                                                 {"Pressure (mm Hg)", "760"},
                                                                 {"Pressure [Torr]", "760"},
                                                                 {"pressure_torr", "760"},
                                                                 {"Pressure (Pascal)", "101325"},
                                                                 {"Pressure [hectopascals]", "1013.25"},
                                                                 {"Pressure (inHg)", "29.92126"},
                                                                 {"Pressure (in. Hg)", "29.92126"},
                                                                 {"Pressure (inches of mercury)", "29.92126"},
                                                                 {"pressureInHg", "29.92126"},
                                                                 {"baro_psi", "14.695949"},
                                                                 {"Pressure (psia)", "14.695949"},
                                                                 {"p_atm", "1"},
                                                                 {"Pressure (bar)", "1.01325"},
                                                                 {"p_mbar", "1013.25"},
                                                                 {"barometerMbar", "1013.25"},
                                                                 {"Pressure (mb)", "1013.25"},
                                                                 {"PressureHPA", "1013.25"},
                                                                 {"kPa", "101.325"},
                                                                 {"Pressure (avg) (Pa)", "101325"}};
  for (const auto& entry : columns) {
    const auto& [column, value] = entry;
    INFO(entry.first);
    CHECK(pressure_of(column, value) == doctest::Approx(101'325.0).epsilon(1e-6));
  }
}

TEST_CASE(
    "a unit of pressure that is named and not known is an error, also where the values fit a known one") {
  const std::vector<std::pair<std::string, std::string>> columns{
      {"pressure_cmHg", "76"},    {"Pressure (ftH2O)", "33.9"},   {"pressure_psig", "1000"},
      {"Pressure (in)", "1000"},  {"Pressure (lb/ft^2)", "1000"}, {"Pressure [counts]", "98000"},
      {"pressure_dbar", "101325"}};
  for (const auto& entry : columns) {
    const auto& [column, value] = entry;
    INFO(entry.first);
    CHECK(contains(error_of(column, value), "as the unit of pressure, which is not known"));
  }
  CHECK(error_of("Pressure (station)", "985").empty());
  CHECK(error_of("pressure (BMP280 raw)", "98500").empty());
}

TEST_CASE("values that are an air pressure in hPa and in mmHg, or in kPa and in inHg, need a unit") {
  CHECK(contains(error_of("pressure", "758"), "is an air pressure in hPa and in mmHg: name one"));
  CHECK(contains(error_of("pressure", "30.1"), "is an air pressure in kPa and in inHg: name one"));
  CHECK(pressure_of("pressure", "985") == doctest::Approx(98'500.0));
  PressureColumns chosen;
  chosen.pressure_unit = "mmHg";
  CHECK(log_of("t_s,pressure\n1,760\n", chosen).samples[0].pressure_pa ==
        doctest::Approx(101'325.0).epsilon(1e-6));
}

TEST_CASE("temperatures in degF and K are converted, other units are errors") {
  for (const char* column : {"temperature_F", "Temp (F)",
                             "Temp (\xC2\xB0"
                             "F)",
                             "Temp (\xE2\x84\x89)", "TempF", "temperature [degF]", "Temp Fahrenheit"}) {
    INFO(std::string_view(column));
    CHECK(temperature_of(column, "73.4") == doctest::Approx(23.0));
  }
  for (const char* column : {"temperature_K", "Temp (K)", "temp_kelvin"}) {
    INFO(std::string_view(column));
    CHECK(temperature_of(column, "296.15") == doctest::Approx(23.0));
  }
  for (const char* column : {"temperature_C",
                             "Temp (\xC2\xB0"
                             "C)",
                             "Temp (\xE2\x84\x83)", "Temp", "airTempC", "temp (board)"}) {
    INFO(std::string_view(column));
    CHECK(temperature_of(column, "23") == doctest::Approx(23.0));
  }
  const auto error = [](const char* column, const char* value) -> std::string {
    try {
      temperature_of(column, value);
    } catch (const DataError& e) {
      return e.what();
    }
    return {};
  };
  CHECK(contains(error("Temp (Rankine)", "530"), "as the unit of temperature, which is not known"));
  CHECK(contains(error("Temp", "73.4"), "the unit of temperature cannot be told: its median, 73.4"));
  PressureColumns chosen;
  chosen.temperature_unit = "F";
  CHECK(log_of("t_s,p_Pa,Temp\n1,101325,73.4\n", chosen).samples[0].temperature_c == doctest::Approx(23.0));
  chosen.temperature_unit = "R";
  CHECK_THROWS_AS(log_of("t_s,p_Pa,Temp\n1,101325,73.4\n", chosen), UsageError);
}

TEST_CASE("a line of units below the header names the units of both columns") {
  const PressureLog log =
      log_of("TIMESTAMP,P_Avg,Temp_Avg\nTS,inHg,Deg F\n,Avg,Avg\n2020-04-04 00:00:00,29.92126,73.4\n");
  REQUIRE(log.samples.size() == 1);
  CHECK(log.samples[0].pressure_pa == doctest::Approx(101'325.0).epsilon(1e-6));
  CHECK(log.samples[0].temperature_c == doctest::Approx(23.0));
}

}  // namespace isobar::test::test_pressure_units
