// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tools/report/well_formed.hpp"
#include "tools/calibrate_logs.hpp"
#include "tools/commands.hpp"
#include "tools/report/calibration_report.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::test::test_calibrate_command {

using namespace isobar::tools;
using isobar::files::write_text_file;
using isobar::report::fixed;
using isobar::test::TemporaryFolder;

namespace {

int calibrate_exit(std::vector<std::string> words) {
  words.insert(words.begin(), "calibrate");
  return test::exit_code(add_calibrate_command, words);
}

/// Logs of three days: a sensor with an error of -1.9 Pa/K whose clock is an hour and 17 s ahead, and a
/// station.
struct Rig {
  double temperature_swing_k = 15.0;
  std::string pressure_name = "P_hPa";
  double pressure_unit_pa = 100.0;

  void write(const std::filesystem::path& folder) const {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::string station = "time,pressure_pa\n";
    std::vector<std::string> sensor(3, "time_s,Ta," + pressure_name + "\n");
    double weather_pa = 98'500.0;
    for (int minute = 0; minute < 3 * 1440; ++minute) {
      weather_pa += 3.0 * normal(random);
      const double time_s = 1.6e9 + 60.0 * minute;
      const double temperature_c = 12.0 + temperature_swing_k * std::sin(minute / 229.0);
      const double raw_pa = weather_pa + 130.0 + 1.9 * (temperature_c - 12.0) + 0.8 * normal(random);
      station += fixed(time_s, 0) + "," + fixed(weather_pa, 1) + "\n";
      sensor[static_cast<std::size_t>(minute / 1440)] += fixed(time_s + 3'617.0, 0) + "," +
                                                         fixed(temperature_c, 2) + "," +
                                                         fixed(raw_pa / pressure_unit_pa, 4) + "\n";
    }
    write_text_file(folder / "station.csv", station);
    for (std::size_t k = 0; k < 3; ++k)
      write_text_file(folder / ("day" + std::to_string(k) + ".csv"), sensor[k]);
  }
};

/// The logs of one of the real sensors; empty where the shared data are absent.
CalibrationLogs real_logs(const std::string& sensor) {
  CalibrationLogs logs;
  const std::filesystem::path folder = std::filesystem::path(ISOBAR_SHARED_DATA) / "baro-temperature";
  if (!std::filesystem::exists(folder)) return logs;
  for (const char* day : {"03", "04", "05", "06"}) {
    logs.sensor.files.push_back(folder / ("Ta_RH_Test-2020-04-" + std::string(day) + ".csv"));
    logs.reference.files.push_back(folder / ("FRWRTM_MET_1min_2020-04-" + std::string(day) + ".csv"));
  }
  logs.sensor.columns.pressure = sensor + "_P";
  logs.sensor.columns.temperature = sensor + "_Ta";
  logs.reference.columns.pressure = "MET_PTB100_PressureActual_hPa_Avg";
  logs.reference.columns.needs_temperature = false;
  return logs;
}

bool any_contains(const std::vector<std::string>& lines, const std::string& words) {
  for (const std::string& line : lines) {
    if (line.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE(
    "isobar calibrate finds the clock shift, fits the sensor, and writes a file that the daemon loads") {
  const TemporaryFolder folder;
  Rig{}.write(folder.path());
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  CHECK(calibrate_exit({"--sensor", path("day0.csv"), path("day1.csv"), path("day2.csv"), "--reference",
                        path("station.csv"), "--out", path("out.toml"), "--report", path("report.html")}) ==
        0);
  const CompensationConfig config = load_compensation(path("out.toml"));
  CHECK(config.model == CompensationModel::kSimple);
  SensorCompensation compensation(config);
  for (const double temperature_c : {0.0, 12.0, 25.0}) {
    PressureSample sample{0, 98'600.0 + 130.0 + 1.9 * (temperature_c - 12.0), temperature_c};
    CHECK(compensation.apply(sample) == SensorCompensation::Result::kInside);
    // 0.5 Pa: 4320 samples with 0.8 Pa of noise, interpolated in a weather of 3 Pa a minute.
    CHECK(std::abs(sample.pressure_pa - 98'600.0) < 0.5);
  }
  // Sensor 0.8 Pa, and the weather between the station's samples.
  CHECK(config.sigma_pa > 0.7);
  CHECK(config.sigma_pa < 2.0);
  const std::string html = files::read_text_file(path("report.html"));
  CHECK(
      test::is_well_formed(html.substr(html.find("<main>"), html.find("</main>") + 7 - html.find("<main>"))));
  CHECK(html.find("Residual against temperature") != std::string::npos);
  CHECK(html.find("isobar calibrate --sensor") != std::string::npos);
  // The daemon's configuration loads the file by name.
  write_text_file(path("isobar.toml"), "[barometer]\ncompensation_file = \"out.toml\"\n");
  CHECK(load_config(path("isobar.toml")).prior.compensation.model == CompensationModel::kSimple);
}

TEST_CASE("units are found from names or values, and reported") {
  const TemporaryFolder folder;
  for (const auto& [name, unit_pa, said] : std::vector<std::tuple<std::string, double, std::string>>{
           {"P_mbar", 100.0, "in hPa (column 'P_mbar', as the column's name says)"},
           {"pressure", 1'000.0, "in kPa (column 'pressure', the only unit in which its median"},
           {"baro_pa", 1.0, "in Pa (column 'baro_pa', as the column's name says)"}}) {
    Rig rig;
    rig.pressure_name = name;
    rig.pressure_unit_pa = unit_pa;
    rig.write(folder.path());
    CalibrationLogs logs;
    logs.sensor.files = {folder.path() / "day1.csv"};
    logs.reference.files = {folder.path() / "station.csv"};
    const AlignedLogs aligned = align_logs(logs);
    CHECK(any_contains(aligned.notes, said));
    CHECK(any_contains(aligned.notes, "the reference's time is the sensor's - 361"));
    CHECK(calibrate(aligned.recordings).model(CompensationModel::kSimple).residual.rms_pa < 3.0);
  }
}

TEST_CASE("mistakes end with their exit code: usage 64, data 65") {
  const TemporaryFolder folder;
  Rig{}.write(folder.path());
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const std::string day = path("day0.csv");
  const std::string station = path("station.csv");
  CHECK(calibrate_exit({"--sensor", day}) == 64);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--window", "-1"}) == 64);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--model", "A_cubic"}) == 64);
  CHECK(calibrate_exit({"--sensor", day, path("day1.csv"), "--reference", station, "--paired"}) == 64);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--sensor-columns", ",:fathom"}) == 64);
  CHECK(calibrate_exit({"--sensor", day, "--reference", path("none.csv")}) == 65);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--sensor-columns", ",P"}) == 65);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--sensor-columns", ",:kPa"}) == 65);
  CHECK(calibrate_exit({"--sensor", day, "--reference", day}) == 65);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, station}) == 65);
  // The clocks are an hour apart: no shift within a minute aligns the logs.
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--window", "0.02"}) == 65);
  // A copy of the sensor's log is refused as a reference.
  std::filesystem::copy_file(day, path("copy.csv"));
  CHECK(calibrate_exit({"--sensor", day, "--reference", path("copy.csv")}) == 65);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--out", path("no/folder.toml")}) == 64);
}

TEST_CASE("logs at a single temperature are refused without --pressure-only") {
  const TemporaryFolder folder;
  Rig rig;
  rig.temperature_swing_k = 0.2;
  rig.write(folder.path());
  const std::string day = (folder.path() / "day0.csv").string();
  const std::string station = (folder.path() / "station.csv").string();
  const std::string out = (folder.path() / "out.toml").string();
  CHECK(calibrate_exit({"--sensor", day, "--reference", station}) == 65);
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--pressure-only", "--out", out}) == 0);
  CHECK_FALSE(uses_temperature(load_compensation(out).model));
  CHECK(calibrate_exit({"--sensor", day, "--reference", station, "--pressure-only", "--model", "A_simple"}) ==
        65);
}

TEST_CASE("paired logs have a clock each; two columns of one file share a clock") {
  const TemporaryFolder folder;
  Rig{}.write(folder.path());
  CalibrationLogs logs;
  logs.paired = true;
  logs.sensor.files = {folder.path() / "day0.csv", folder.path() / "day1.csv"};
  logs.reference.files = {folder.path() / "station.csv", folder.path() / "station.csv"};
  const AlignedLogs paired = align_logs(logs);
  CHECK(paired.recordings.size() == 2);
  CHECK(paired.notes.size() >= 6);
  std::string text = "t_s,here,there,temp\n";
  for (int k = 0; k < 300; ++k)
    text += std::to_string(k) + "," + fixed(985.0 + 0.01 * k, 2) + "," + fixed(985.5 + 0.01 * k, 2) + "," +
            std::to_string(k % 30) + "\n";
  write_text_file(folder.path() / "both.csv", text);
  CalibrationLogs both;
  both.sensor = {{folder.path() / "both.csv"}, {}};
  both.reference = both.sensor;
  both.sensor.columns.pressure = "here";
  both.reference.columns.pressure = "there";
  both.reference.columns.needs_temperature = false;
  const AlignedLogs aligned = align_logs(both);
  CHECK(any_contains(aligned.notes, "share its clock"));
  CHECK(calibrate(aligned.recordings).models[1].residual.rms_pa < 1e-6);
}

TEST_CASE(
    "real sensors: the shift of two hours is found, and A_simple leaves at most 60 % of the residual of an "
    "offset") {
  for (const char* sensor : {"1_BME280", "2_BME280", "1_BME680", "2_BME680"}) {
    const CalibrationLogs logs = real_logs(sensor);
    if (logs.sensor.files.empty()) {
      MESSAGE("skipped: no shared data");
      return;
    }
    CAPTURE(sensor);
    const AlignedLogs aligned = align_logs(logs);
    const Calibration calibration = calibrate(aligned.recordings);
    const ResidualFigures& simple = calibration.model(CompensationModel::kSimple).residual;
    const ResidualFigures& offset = calibration.model(CompensationModel::kOffset).residual;
    MESSAGE(std::string(sensor), ": rms ", simple.rms_pa, " of ", offset.rms_pa, " Pa, median |r| ",
            simple.median_abs_pa, " of ", offset.median_abs_pa, " Pa");
    CHECK(simple.rms_pa <= 0.6 * offset.rms_pa);
    CHECK(simple.median_abs_pa <= 0.6 * offset.median_abs_pa);
    // Two hours minus up to two minutes: averages over a minute are stamped at its end, and both loggers'
    // clocks were set by hand.
    CHECK(any_contains(aligned.notes, "the reference's time is the sensor's - 71"));
    // Three days and 6 hPa do not suffice for sixteen coefficients.
    CHECK(calibration.models[calibration.recommended].model != CompensationModel::kFull);
    CHECK(uses_temperature(calibration.models[calibration.recommended].model));
  }
}

TEST_CASE("the table has a row per model, the reason for the recommendation, and why models are missing") {
  const TemporaryFolder folder;
  Rig rig;
  rig.temperature_swing_k = 0.2;
  rig.write(folder.path());
  CalibrationLogs logs;
  logs.sensor.files = {folder.path() / "day0.csv"};
  logs.reference.files = {folder.path() / "station.csv"};
  const AlignedLogs aligned = align_logs(logs);
  const Calibration calibration = calibrate(aligned.recordings);
  const std::string table = report::calibration_table(calibration, aligned.recordings);
  CHECK(table.find("A'_m, as it is") != std::string::npos);
  CHECK(table.find("A_simple was left out: the temperature spans only 0.4 K") != std::string::npos);
  CHECK(table.find("Recommended is offset: ") != std::string::npos);
  CHECK(table.find("nan") == std::string::npos);
  report::CalibrationReport page;
  page.title = "a <b>";
  page.calibration = calibration;
  page.recordings = aligned.recordings;
  const std::string html = report::render_calibration_report(page);
  CHECK(
      test::is_well_formed(html.substr(html.find("<main>"), html.find("</main>") + 7 - html.find("<main>"))));
}

}  // namespace isobar::test::test_calibrate_command
