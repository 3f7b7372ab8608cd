// SPDX-License-Identifier: BSD-3-Clause
// Heights from logs: a synthetic climb, and a real DPS310 beside survey-grade GNSS.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/calibration/height_difference.hpp"
#include "core/calibration/weather_smoother.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"
#include "tools/height_errors.hpp"
#include "tools/inertial_heights.hpp"
#include "tools/pressure_log.hpp"

namespace isobar::test::test_altitude_command {

using isobar::files::read_text_file;
using isobar::files::write_text_file;
using isobar::test::TemporaryFolder;

namespace {

int altitude(std::vector<std::string> words) {
  words.insert(words.begin(), "altitude");
  return isobar::test::exit_code(tools::add_altitude_command, std::move(words));
}

/// A log of a minute in weather of 1 Pa/s, with a steady climb.
std::string log(double climb_m_s, double dt_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 0.2);
  std::string text = "t_ns,pressure_pa,temperature_c\n";
  for (double t = 0.0; t < 60.0; t += dt_s) {
    text += std::to_string(1'760'000'000'000'000'000 + std::llround(1e9 * t)) + "," +
            std::to_string(101'000.0 + t - 11.9 * climb_m_s * t + normal(random)) + ",17.0\n";
  }
  return text;
}

std::filesystem::path ugv() { return std::filesystem::path(ISOBAR_SHARED_DATA) / "dps310-ugv"; }

}  // namespace

TEST_CASE("isobar altitude writes heights, and each mistake has its exit code") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  write_text_file(path("moved.csv"), log(0.2, 0.03, 1));
  write_text_file(path("base.csv"), log(0.0, 0.05, 2));
  write_text_file(path("station.csv"), log(0.0, 12.0, 3));
  std::string climb;
  for (int i = 0; i <= 600; ++i) {
    climb += std::to_string(1'760'000'000 + i / 10) + "." + std::to_string(i % 10) + " 0 0 " +
             std::to_string(0.02 * i) + " 0 0 0 1\n";
  }
  write_text_file(path("truth.tum"), climb);
  write_text_file(path("later.tum"), "1770000000 0 0 0 0 0 0 1\n1770000000.1 0 0 0 0 0 0 1\n");
  CHECK(altitude({path("moved.csv"), "--base", path("base.csv"), "--out", path("h.csv")}) == 0);
  const std::string heights = read_text_file(path("h.csv"));
  const std::size_t comma = heights.rfind(',');
  // 12 m in a minute, minus the last second, which the delay cuts off; 60 Pa of weather would be 5 m.
  CHECK(std::stod(heights.substr(comma + 1)) == doctest::Approx(11.8).epsilon(0.02));
  CHECK(altitude({path("moved.csv"), "--base", path("station.csv"), "--reference", path("truth.tum")}) == 0);
  CHECK(altitude({path("moved.csv"), "--lag", "0"}) == 0);
  CHECK(altitude({}) == 64);
  CHECK(altitude({path("moved.csv"), "--lag", "-1"}) == 64);
  CHECK(altitude({path("moved.csv"), "--base", path("none.csv")}) == 65);
  CHECK(altitude({path("moved.csv"), "--reference", path("later.tum")}) == 65);
  CHECK(altitude({path("moved.csv"), "--out", path("no/such/folder.csv")}) == 64);
  write_text_file(path("one.csv"), "t_ns,pressure_pa,temperature_c\n1,101000,20\n");
  CHECK(altitude({path("one.csv")}) == 65);
}

TEST_CASE("a thermometer hotter than any air needs --air; one that is not the only one does not matter") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const auto with_temperature = [](std::string text, const char* temperature) {
    for (std::size_t at = text.find(",17.0\n"); at != std::string::npos; at = text.find(",17.0\n", at + 1)) {
      text.replace(at, 5, temperature);
    }
    return text;
  };
  write_text_file(path("cool.csv"), log(0.0, 0.05, 2));
  for (const char* hot : {",50.0", ",73.4"}) {
    write_text_file(path("hot.csv"), with_temperature(log(0.2, 0.03, 1), hot));
    CHECK(altitude({path("hot.csv")}) == 65);
    CHECK(altitude({path("hot.csv"), "--air", "23"}) == 0);
    CHECK(altitude({path("hot.csv"), "--base", path("cool.csv")}) == 0);
  }
}

TEST_CASE(
    "equal values of a coarse station are measurements, those of a chip that is polled too fast are "
    "repeats") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::string coarse = "t_ns,pressure_pa\n";
  std::string polled = coarse;
  std::string minutes = coarse;
  for (int i = 0; i < 1000; ++i) {
    const std::string t = std::to_string(1'760'000'000'000'000'000 + 500'000'000LL * i) + ",";
    coarse += t + std::to_string(10 * std::lround(10'100.0 + 0.3 * normal(random))) + "\n";
    const std::string value = std::to_string(101'000.0 + 0.3 * normal(random));
    polled +=
        t + value + "\n" + std::to_string(1'760'000'000'250'000'000 + 500'000'000LL * i) + "," + value + "\n";
    minutes += std::to_string(1'760'000'000'000'000'000 + 60'000'000'000LL * i) + "," +
               std::to_string(100'000 + i / 2) + ".25\n";
  }
  write_text_file(path("coarse.csv"), coarse);
  write_text_file(path("polled.csv"), polled);
  write_text_file(path("minutes.csv"), minutes);
  CHECK(tools::read_new_values(path("coarse.csv")).samples.size() == 1000);
  CHECK(tools::read_new_values(path("polled.csv")).samples.size() == 1000);
  CHECK(tools::read_new_values(path("minutes.csv")).samples.size() == 1000);
}

TEST_CASE(
    "clocks of two logs that overlap are trusted, whatever their lengths; others cannot both be right") {
  const auto log_from = [](std::int64_t first_s, std::int64_t last_s) {
    tools::PressureLog log;
    for (const std::int64_t t : {first_s, last_s}) {
      log.samples.push_back({});
      log.samples.back().stamp_ns = (1'760'000'000 + t) * 1'000'000'000;
    }
    return log;
  };
  const tools::PressureLog moved = log_from(0, 110);
  for (const auto& span : {std::pair{5, 112}, {5, 115}, {-30, 90}, {20, 300}, {-100, 10}, {3, 113}}) {
    const auto& [first_s, last_s] = span;
    INFO(span.first);
    tools::PressureLog standing = log_from(first_s, last_s);
    const std::int64_t before_ns = standing.samples.front().stamp_ns;
    CHECK(tools::tie_clocks(moved, standing).find("trusted") != std::string::npos);
    CHECK(standing.samples.front().stamp_ns == before_ns);
  }
  tools::PressureLog apart = log_from(28'800, 28'910);
  CHECK(tools::tie_clocks(moved, apart).find("off by 28800.0 s") != std::string::npos);
  CHECK(apart.samples.front().stamp_ns == moved.samples.front().stamp_ns);
}

TEST_CASE("with an IMU at any mounting angle the height of an elevator ride has no lag") {
  // 20 s at rest, 1.5 m/s for 10 s with 1 m/s^2 at both ends, 10 s at rest; the IMU lies on its side.
  const auto accel = [](double t) {
    return t >= 20.0 && t < 21.5 ? 1.0 : t >= 30.0 && t < 31.5 ? -1.0 : 0.0;
  };
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<ImuSample> imu;
  HeightSeries raw;
  std::vector<evaluation::StampedPose> poses;
  double speed = 0.0;
  double height = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.01 * i;
    ImuSample sample;
    sample.stamp_ns = 1'760'000'000'000'000'000 + 10'000'000LL * i;
    sample.accel_m_s2 = {0.02 * normal(random), kGravity + accel(t - 0.005) + 0.02 * normal(random),
                         0.02 * normal(random)};
    sample.gyro_rad_s = Eigen::Vector3d::Constant(0.001 * normal(random));
    imu.push_back(sample);
    const double before = speed;
    speed += 0.01 * accel(t - 0.005);
    height += 0.005 * (before + speed);
    evaluation::StampedPose pose;
    pose.stamp_ns = sample.stamp_ns;
    pose.position_m.z() = height;
    poses.push_back(pose);
    if (i % 3 != 0) continue;
    raw.stamps_ns.push_back(sample.stamp_ns);
    raw.heights_m.push_back(7.0 + height + 0.04 * normal(random));
  }
  const HeightSeries series = tools::inertial_heights(imu, raw, 0.04, HeightSource::kDifferential);
  CHECK(series.heights_m.size() > raw.heights_m.size() - 30);
  const auto errors = tools::height_errors(series, evaluation::make_trajectory(poses));
  // A lag of a fifth of a second would be 30 cm here.
  CHECK(errors.range_m == doctest::Approx(15.0).epsilon(0.01));
  CHECK(errors.largest_m < 0.08);
  CHECK(tools::inertial_heights({}, raw, 0.04, HeightSource::kDifferential).heights_m.empty());
}

TEST_CASE("on a real robot outdoors heights are within 12 cm rms of survey-grade GNSS") {
  if (!std::filesystem::exists(ugv() / "dps310.csv")) {
    MESSAGE("skipped: no shared data");
    return;
  }
  // Default settings: a lag of 1 s, the air temperature of the coldest sensor. Only the mean difference is
  // fitted, because the zero of a barometer's height is arbitrary.
  const auto read = [](const char* file, const char* columns) {
    return tools::read_new_values(ugv() / file, tools::parse_columns(columns));
  };
  const tools::PressureLog log = read("dps310.csv", "timestamp:us,pressure,temperature");
  const tools::PressureLog rows = read("meteo_data.csv", "TIMESTAMP:us,CS106_Raw_mbar:hPa,T_probe_Avg");
  CHECK(rows.samples.size() == 3);
  const auto truth = evaluation::parse_tum(read_text_file(ugv() / "gt.txt"), "gt.txt");
  const double air_k = 273.15 + *tools::coldest_c({&log.samples, &rows.samples});
  const auto errors = [&](double lag_s, bool with_station) {
    const FilteredPressure filtered = filter_log(log.samples, lag_s);
    FilteredPressure base;
    base.stamps_ns = {filtered.stamps_ns.front()};
    base.pressures_pa = {filtered.pressures_pa.front()};
    if (with_station) base = smooth_weather(rows.samples);
    return tools::height_errors(height_difference(filtered, base, air_k), truth);
  };
  for (const double lag_s : {0.0, 1.0}) {
    for (const bool with_station : {false, true}) {
      const tools::HeightErrors result = errors(lag_s, with_station);
      MESSAGE("lag ", lag_s, " s, ", std::string(with_station ? "three rows of the station" : "no base"),
              ": rms ", result.rms_m, " m, largest ", result.largest_m, " m of ", result.range_m, " m");
      CHECK(result.count > 400);
      CHECK(result.rms_m < 0.12);
    }
  }
  // The delay is subtracted: uncorrected, 1 s at up to 0.12 m/s would make the errors larger than without
  // low-pass.
  CHECK(errors(1.0, false).rms_m < errors(0.0, false).rms_m);
}

}  // namespace isobar::test::test_altitude_command
