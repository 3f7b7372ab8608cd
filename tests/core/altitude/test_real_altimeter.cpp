// SPDX-License-Identifier: BSD-3-Clause
// The altimeter on a real DPS310, recorded on a robot beside survey-grade GNSS.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/altitude/differential_altimeter.hpp"

namespace isobar::test::test_real_altimeter {

namespace {

std::vector<std::vector<double>> numbers(const std::filesystem::path& file, char separator, bool header) {
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  std::string line;
  if (header) std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), separator, ' ');
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; words >> value;) row.push_back(value);
    if (row.size() > 2) rows.push_back(row);
  }
  return rows;
}

}  // namespace

TEST_CASE("a real DPS310, polled faster than it converts, follows the survey-grade height") {
  const std::filesystem::path folder = std::filesystem::path(ISOBAR_SHARED_DATA) / "dps310-ugv";
  if (!std::filesystem::exists(folder / "dps310.csv")) {
    MESSAGE("skipped: no shared data");
    return;
  }
  const auto barometer = numbers(folder / "dps310.csv", ',', true);
  const auto truth = numbers(folder / "gt.txt", ' ', false);
  REQUIRE(barometer.size() > 1000);
  REQUIRE(truth.size() > 300);
  DifferentialAltimeter altimeter{AltimeterConfig{}};
  std::size_t repeated = 0;
  std::vector<std::pair<double, double>> heights;
  for (const auto& row : barometer) {
    AltimeterReading reading;
    const PressureSample sample{static_cast<std::int64_t>(row[0]) * 1000, row[14], row[15]};
    const PressureStatus status = altimeter.add_robot(sample, reading);
    if (status == PressureStatus::kRepeated) ++repeated;
    if (status == PressureStatus::kAccepted) heights.emplace_back(row[0] * 1e-6, reading.height_m);
  }
  // 100 Hz polling of about 10 conversions a second.
  CHECK(repeated > barometer.size() / 2);
  double sum = 0.0;
  double sum_of_squares = 0.0;
  double count = 0.0;
  for (const auto& [t, height] : heights) {
    const auto after =
        std::find_if(truth.begin(), truth.end(), [&, at = t](const auto& row) { return row[0] >= at; });
    if (after == truth.end() || (*after)[0] - t > 0.2) continue;
    const double error = height - ((*after)[3] - truth.front()[3]);
    sum += error;
    sum_of_squares += error * error;
    count += 1.0;
  }
  REQUIRE(count > 200.0);
  const double deviation = std::sqrt(sum_of_squares / count - (sum / count) * (sum / count));
  MESSAGE("standard deviation against GNSS over a minute outdoors, single barometer: ", deviation, " m");
  // Wind and a minute of weather: 0.3 m is 3.5 Pa.
  CHECK(deviation < 0.3);
}

}  // namespace isobar::test::test_real_altimeter
