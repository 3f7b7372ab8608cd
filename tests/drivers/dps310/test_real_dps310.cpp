// SPDX-License-Identifier: BSD-3-Clause
// The compensation on a minute of a real DPS310: registers, coefficients and results logged by its own
// driver.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/dps310/compensation.hpp"

namespace isobar::test::test_real_dps310 {

using namespace isobar::dps310;

namespace {

constexpr std::size_t kColumns = 16;
constexpr std::size_t kRawPressure = 10;
constexpr std::size_t kRawTemperature = 11;
constexpr std::size_t kPressureScale = 12;
constexpr std::size_t kTemperatureScale = 13;
constexpr std::size_t kPressure = 14;
constexpr std::size_t kTemperature = 15;

using Row = std::array<double, kColumns>;

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<Row> rows;
  std::string line;
  std::getline(in, line);
  REQUIRE(line ==
          "timestamp,c0,c1,c00,c01,c10,c11,c20,c21,c30,raw_pressure,raw_temperature,scale_pressure,"
          "scale_temperature,pressure,temperature");
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    Row row{};
    std::string field;
    for (double& value : row) {
      REQUIRE(std::getline(fields, field, ','));
      value = std::stod(field);
    }
    rows.push_back(row);
  }
  return rows;
}

Compensated compensated(const Row& row) {
  const auto whole = [&](std::size_t column) { return static_cast<std::int32_t>(row[column]); };
  const Coefficients c{whole(1), whole(2), whole(3), whole(5), whole(4),
                       whole(6), whole(7), whole(8), whole(9)};
  return compensate(c, {whole(kRawPressure), whole(kRawTemperature)}, row[kPressureScale],
                    row[kTemperatureScale]);
}

/// A row is torn when its result is newer than its registers: the result differs from the row before, the
/// registers do not. The sensor was updated between the logger's read of the registers and its read of the
/// result.
bool torn(const Row& before, const Row& row) {
  const bool raw_temperature_same = row[kRawTemperature] == before[kRawTemperature];
  const bool raw_same = raw_temperature_same && row[kRawPressure] == before[kRawPressure];
  return (raw_same && row[kPressure] != before[kPressure]) ||
         (raw_temperature_same && row[kTemperature] != before[kTemperature]);
}

}  // namespace

TEST_CASE(
    "a real sensor's logged pressure and temperature are met to 1e-6 Pa on every row that is not torn") {
  const std::filesystem::path file = std::filesystem::path(ISOBAR_SHARED_DATA) / "dps310-ugv" / "dps310.csv";
  if (!std::filesystem::exists(file)) {
    MESSAGE("skipped: no shared data");
    return;
  }
  const std::vector<Row> rows = read_rows(file);
  REQUIRE(rows.size() > 5000);
  std::size_t torn_rows = 0;
  std::size_t torn_pressures = 0;
  double largest_pa = 0.0;
  double largest_k = 0.0;
  double smallest_torn_pa = 1e9;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Compensated value = compensated(rows[i]);
    const double pressure_error = std::abs(value.pressure_pa - rows[i][kPressure]);
    const double temperature_error = std::abs(value.temperature_c - rows[i][kTemperature]);
    if (i > 0 && torn(rows[i - 1], rows[i])) {
      ++torn_rows;
      if (rows[i][kPressure] != rows[i - 1][kPressure]) ++torn_pressures;
      // Torn rows must disagree: otherwise the rule could hide a wrong formula.
      smallest_torn_pa = std::min(smallest_torn_pa, std::max(pressure_error, temperature_error));
      continue;
    }
    largest_pa = std::max(largest_pa, pressure_error);
    largest_k = std::max(largest_k, temperature_error);
  }
  MESSAGE(rows.size() << " rows, " << torn_rows << " torn (" << torn_pressures
                      << " of them in the pressure), largest error of the others " << largest_pa << " Pa and "
                      << largest_k << " K");
  CHECK(largest_pa < 1e-6);
  CHECK(largest_k < 1e-9);
  CHECK(smallest_torn_pa > 1e-6);
  // 600 updates in a minute, logged every 10 ms: a row is torn where the update falls between two reads that
  // lie 1 ms apart.
  CHECK(torn_rows == 59);
  CHECK(torn_pressures == 29);  // the 0.5 % of rows whose pressure is not that of their registers
}

}  // namespace isobar::test::test_real_dps310
