// SPDX-License-Identifier: BSD-3-Clause
// `isobar calibrate`: fits the compensation that isobard loads, from logs of a barometer beside a reference.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/config_io.hpp"
#include "core/calibration/calibration.hpp"
#include "core/errors.hpp"
#include "tools/calibrate_logs.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/output_option.hpp"
#include "tools/pressure_log.hpp"
#include "tools/progress.hpp"
#include "tools/report/calibration_report.hpp"
#include "tools/report/number_text.hpp"
#include "tools/subcommand.hpp"
#include "tools/typed_words.hpp"

namespace isobar::tools {

namespace {

constexpr double kSecondsPerHour = 3600.0;

struct CalibrateOptions {
  CalibrationLogs logs;
  std::string sensor_columns;
  std::string reference_columns;
  double window_h = 6.0;
  bool pressure_only = false;
  std::string model;
  std::filesystem::path out;
  std::filesystem::path report;
  std::string title;
};

/// The model named by --model, else the recommended one.
/// @throws DataError when the logs do not suffice for the model
/// @throws UsageError when there is no such model
CompensationModel chosen_model(const CalibrateOptions& options, const Calibration& calibration) {
  if (options.model.empty()) return calibration.models[calibration.recommended].model;
  const std::optional<CompensationModel> model = kCompensationModelNames.value(options.model);
  if (!model) {
    throw UsageError("--model: \"" + options.model + "\" is none of " + kCompensationModelNames.joined());
  }
  const std::string& left_out = calibration.model(*model).left_out;
  if (!left_out.empty()) throw DataError(options.model + " cannot be fitted: " + left_out);
  return *model;
}

/// Logs at a single temperature do not determine temperature terms; the user must accept that.
/// @throws DataError when temperature terms cannot be fitted and --pressure-only is not given
void require_temperatures(const CalibrateOptions& options, const AlignedLogs& logs,
                          const Calibration& calibration) {
  const ModelResult& simple = calibration.model(CompensationModel::kSimple);
  if (options.pressure_only || simple.left_out.empty()) return;
  throw DataError(
      (logs.has_temperature ? simple.left_out : "the sensor's log has no temperature") +
      std::string(": record the sensor at other temperatures as well, or pass --pressure-only to fit "
                  "offset and A_p only"));
}

std::string file_comment(const CalibrateOptions& options, const Calibration& calibration,
                         CompensationModel chosen) {
  using report::fixed;
  const ModelResult& result = calibration.model(chosen);
  std::string files;
  for (const auto& file : options.logs.sensor.files) files += " " + file.filename().string();
  return "Calibration of one barometer by `isobar calibrate`, from" + files + ": " +
         std::to_string(calibration.pair_count) + " samples beside the reference.\nResidual: median |r| " +
         fixed(result.residual.median_abs_pa, 2) + " Pa, sd " + fixed(result.residual.sd_pa, 2) +
         " Pa, p95 |r| " + fixed(result.residual.p95_abs_pa, 2) + " Pa; cross-validated rms " +
         fixed(result.cross_validated_rms_pa, 2) + " Pa.\nTo use it, name this file in isobar.toml: " +
         "barometer.compensation_file for the robot's sensor, base_barometer.compensation_file for the base "
         "station's. Or copy the section there as [barometer.compensation].";
}

void print_lines(const char* prefix, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::printf("%s%s\n", prefix, line.c_str());
}

void print_result(const AlignedLogs& logs, const Calibration& calibration) {
  print_lines("", logs.notes);
  std::printf("\n%s", report::calibration_table(calibration, logs.recordings).c_str());
  print_lines("warning: ", logs.warnings);
  print_lines("warning: ", calibration.warnings);
}

void run_calibrate(const CalibrateOptions& options, const std::string& command) {
  if (options.logs.sensor.files.empty())
    throw UsageError("--sensor: missing; `isobar calibrate --help` explains it");
  if (options.logs.reference.files.empty()) {
    throw UsageError("--reference: missing; `isobar calibrate --help` explains it");
  }
  CalibrationLogs request = options.logs;
  request.window_s = kSecondsPerHour * options.window_h;
  request.sensor.columns = parse_columns(options.sensor_columns);
  request.sensor.columns.needs_temperature = true;
  request.reference.columns = parse_columns(options.reference_columns);
  request.reference.columns.needs_temperature = false;
  Progress progress("reading and fitting");
  report::CalibrationReport page;
  AlignedLogs logs = align_logs(request);
  progress.update(0.5);
  page.calibration = calibrate(logs.recordings);
  const Calibration& calibration = page.calibration;
  require_temperatures(options, logs, calibration);
  page.chosen = chosen_model(options, calibration);
  progress.finish();
  print_result(logs, calibration);
  if (!options.out.empty()) {
    write_output(options.out, show_compensation(calibration.config(page.chosen),
                                                file_comment(options, calibration, page.chosen)));
  }
  if (options.report.empty()) return;
  page.title = options.title.empty() ? "Calibration of a barometer" : options.title;
  page.command = command;
  page.recordings = std::move(logs.recordings);
  page.notes = std::move(logs.notes);
  page.warnings = std::move(logs.warnings);
  write_output(options.report, report::render_calibration_report(page));
}

/// Adds the options that select logs and columns.
void add_log_options(CLI::App& command, CalibrateOptions& options) {
  command.add_option("--sensor", options.logs.sensor.files,
                     "logs of the sensor, each a recording of its own");
  command.add_option("--reference", options.logs.reference.files, "logs of the reference, together one log");
  command.add_flag("--paired", options.logs.paired,
                   "pair the n-th sensor log with the n-th reference log, each pair with its own clocks");
  command.add_option("--sensor-columns", options.sensor_columns, kColumnsHelp);
  command.add_option("--reference-columns", options.reference_columns, "the same for the reference's logs");
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<CalibrateOptions>(
      app, "calibrate", "Fit a barometer's compensation to a reference beside it; find the lidar's mount",
      run_calibrate);
  add_calibrate_mounts_command(command);
  command.footer(
      "Logs are CSV files with a header line: time (dates or a number), pressure, and the sensor's "
      "temperature.\n"
      "A recording's barometer.csv is one. The detected columns and units are printed first.\n\n"
      "  isobar calibrate --sensor cold.csv warm.csv --reference station.csv --out dps310.toml\n\n"
      "then, in isobar.toml:  barometer.compensation_file = \"dps310.toml\"");
  add_log_options(command, options);
  auto* shift = command.add_option("--shift", options.logs.shift_s,
                                   "reference clock minus sensor clock [s] (default: searched)");
  command.add_option("--window", options.window_h, "search shifts up to this, in both directions [h]")
      ->check(number_within(0.01, 1000.0))
      ->capture_default_str()
      ->excludes(shift);
  command.add_option("--model", options.model, "write this model instead of the recommended one")
      ->check(one_of({"offset", "A_p", "A_simple", "A_ind", "A_m", "A_full"}))
      ->option_text("offset|A_p|A_simple|A_ind|A_m|A_full");
  command.add_flag("--pressure-only", options.pressure_only,
                   "accept a single temperature: fit offset and A_p only, which need no other");
  command.add_option("--out", options.out, "TOML file for the compensation, which isobar.toml can name")
      ->check(written_as({".toml"}));
  command.add_option("--report", options.report, "HTML file for the report; it opens without a network")
      ->check(written_as({".html", ".htm"}));
  command.add_option("--title", options.title, "headline of the report");
}

}  // namespace isobar::tools
