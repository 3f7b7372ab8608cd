// SPDX-License-Identifier: BSD-3-Clause
// `isobar altitude`: heights from one barometer's log, relative to a base station's log if there is one.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/calibration/height_difference.hpp"
#include "core/calibration/weather_smoother.hpp"
#include "core/errors.hpp"
#include "core/stamp.hpp"
#include "run/evaluation/trajectory.hpp"
#include "run/files/text_file.hpp"
#include "run/recording/csv_writer.hpp"
#include "run/recording/sample_csv.hpp"
#include "tools/commands.hpp"
#include "tools/height_errors.hpp"
#include "tools/inertial_heights.hpp"
#include "tools/number_option.hpp"
#include "tools/output_option.hpp"
#include "tools/pressure_log.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

// A base with fewer rows than one in this time is a weather station.
constexpr double kSlowBaseS = 5.0;

struct AltitudeArguments {
  std::filesystem::path barometer;
  std::filesystem::path base;
  std::string columns;
  std::string base_columns;
  double lag_s = 1.0;
  std::optional<double> air_c;
  std::filesystem::path imu;
  std::filesystem::path reference;
  std::filesystem::path out;
};

PressureLog read_log(const std::filesystem::path& file, const std::string& columns) {
  PressureLog log = read_new_values(file, parse_columns(columns));
  if (log.samples.size() < 2) throw DataError(file.string() + ": fewer than two samples");
  std::printf("%s: %zu samples\n", file.c_str(), log.samples.size());
  for (const std::string& note : log.notes) std::printf("  %s\n", note.c_str());
  return log;
}

/// Lag of the low-pass; 0 with an IMU, which replaces it.
double lag_s(const AltitudeArguments& arguments) { return arguments.imu.empty() ? arguments.lag_s : 0.0; }

/// The base's pressure as a function of time; `rows` are its samples.
FilteredPressure read_base(const AltitudeArguments& arguments, const PressureLog& moved,
                           std::vector<PressureSample>& rows) {
  PressureLog base = read_log(arguments.base, arguments.base_columns);
  const double interval_s = seconds_between(base.samples.front().stamp_ns, base.samples.back().stamp_ns) /
                            static_cast<double>(base.samples.size() - 1);
  const bool slow = interval_s > kSlowBaseS;
  // A weather station has too few rows to align its clock, which is therefore trusted.
  std::printf(
      "base: one row per %.2f s, %s\n", interval_s,
      slow ? "smoothed as weather (level and rate); its clock is trusted" : tie_clocks(moved, base).c_str());
  rows = std::move(base.samples);
  return slow ? smooth_weather(rows) : filter_log(rows, lag_s(arguments));
}

std::vector<ImuSample> read_imu(const std::filesystem::path& file) {
  text::CsvReader csv = recording::open_imu_csv(file);
  recording::Tally malformed;
  recording::Tally implausible;
  std::vector<ImuSample> samples;
  for (ImuSample sample; recording::next_sample(csv, sample, malformed, implausible);)
    samples.push_back(sample);
  std::printf("%s: %zu samples, %ju bad rows %s\n", file.c_str(), samples.size(),
              std::uintmax_t{malformed.count} + std::uintmax_t{implausible.count},
              (malformed.count > 0 ? malformed : implausible).first_message.c_str());
  return samples;
}

HeightSeries carried_by_imu(const AltitudeArguments& arguments, const HeightSeries& raw, double sigma_m) {
  const HeightSource source =
      arguments.base.empty() ? HeightSource::kSingleBarometer : HeightSource::kDifferential;
  HeightSeries series = inertial_heights(read_imu(arguments.imu), raw, sigma_m, source);
  if (series.heights_m.empty()) {
    throw DataError(arguments.imu.string() +
                    ": no heights: gravity was not found, or the times differ from the barometer's");
  }
  std::printf("no low-pass: vertical acceleration bridges the samples, each with %.3f m of white noise\n",
              sigma_m);
  return series;
}

HeightSeries heights(const AltitudeArguments& arguments) {
  const PressureLog moved = read_log(arguments.barometer, arguments.columns);
  const FilteredPressure filtered = filter_log(moved.samples, lag_s(arguments));
  std::vector<PressureSample> rows;
  FilteredPressure base;
  if (arguments.base.empty()) {
    base.stamps_ns = {filtered.stamps_ns.front()};
    base.pressures_pa = {filtered.pressures_pa.front()};
    std::printf("no base: the heights contain the weather\n");
  } else {
    base = read_base(arguments, moved, rows);
  }
  const double air_c = air_c_of(arguments.air_c, {&moved.samples, &rows});
  HeightSeries series = height_difference(filtered, base, air_c + kZeroCelsiusK);
  if (arguments.imu.empty()) {
    std::printf(
        "low-pass: lag %.2f s, subtracted from the stamps; white noise %.3f Pa per sample, %.3f Pa left\n",
        filtered.design.delay_s, filtered.sigma_pa, filtered.design.output_sigma_pa);
  } else {
    const double m_per_pa = hypsometric_scale_m(air_c + kZeroCelsiusK) / filtered.pressures_pa.front();
    series = carried_by_imu(arguments, series, m_per_pa * std::hypot(filtered.sigma_pa, base.sigma_pa));
  }
  std::printf("air %.1f degC\n", air_c);
  const double start_m = series.heights_m.front();
  for (double& height_m : series.heights_m) height_m -= start_m;
  return series;
}

void write_heights(const std::filesystem::path& file, const HeightSeries& series) {
  recording::TextFile out(file);
  out.write("t_ns,height_m\n");
  for (std::size_t i = 0; i < series.stamps_ns.size(); ++i) {
    out.write(recording::CsvRow().add(series.stamps_ns[i]).add(series.heights_m[i]).finish());
  }
  out.close();
  std::printf("written: %s\n", file.c_str());
}

void compare(const std::filesystem::path& file, const HeightSeries& series) {
  const auto reference = evaluation::parse_tum(files::read_text_file(file), file.string());
  const HeightErrors errors = height_errors(series, reference);
  if (errors.count == 0) throw DataError(file.string() + ": shares no time with the barometer's log");
  std::printf(
      "against %s: %zu heights, after subtraction of the mean difference, %+.3f m:\n"
      "  rms %.4f m, largest %.4f m; height range of the reference %.2f m\n",
      file.c_str(), errors.count, errors.offset_m, errors.rms_m, errors.largest_m, errors.range_m);
}

void run_altitude(const AltitudeArguments& arguments) {
  const HeightSeries series = heights(arguments);
  std::printf("%zu heights over %.1f s, the last one %+.2f m above the first\n", series.heights_m.size(),
              seconds_between(series.stamps_ns.front(), series.stamps_ns.back()), series.heights_m.back());
  if (!arguments.reference.empty()) compare(arguments.reference, series);
  if (!arguments.out.empty()) write_heights(arguments.out, series);
}

}  // namespace

void add_altitude_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<AltitudeArguments>(
      app, "altitude", "Heights from a barometer's log, against a base station or a weather station",
      run_altitude);
  command.add_option("BAROMETER", options.barometer, "CSV of the moved barometer")->required();
  command.add_option(
      "--base", options.base,
      "CSV of the standing barometer; with less than one row in 5 s it is smoothed as weather");
  command.add_option("--columns", options.columns, kColumnsHelp);
  command.add_option("--base-columns", options.base_columns, "the same for the base");
  command.add_option("--lag", options.lag_s, "lag of the low-pass [s]; 0: no low-pass")
      ->capture_default_str()
      ->check(number_within(0.0, 600.0));
  add_air_option(command, options.air_c);
  command.add_option("--imu", options.imu,
                     "imu.csv of the moved barometer: vertical acceleration replaces the low-pass");
  command.add_option("--reference", options.reference, "trajectory (TUM format) to compare the heights with");
  command.add_option("--out", options.out, "CSV file for the heights: t_ns,height_m")
      ->check(written_as({".csv"}));
}

}  // namespace isobar::tools
