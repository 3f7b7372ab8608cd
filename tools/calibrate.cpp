// SPDX-License-Identifier: BSD-3-Clause
// `isobar calibrate`: a barometer beside a reference becomes the compensation that the daemon loads.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "core/calibration/calibration.hpp"
#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "tools/calibrate_logs.hpp"
#include "tools/commands.hpp"
#include "tools/progress.hpp"
#include "tools/report/calibration_report.hpp"
#include "tools/report/svg.hpp"
#include "tools/typed_command.hpp"

namespace isobar::tools {

namespace {

struct CalibrateOptions {
  CalibrationLogs logs;
  double shift_s = 0.0;
  double window_h = 6.0;
  bool pressure_only = false;
  std::string model;
  std::filesystem::path out;
  std::filesystem::path report;
  std::string title;
};

/// The model that was asked for, else the recommended one. Throws DataError where the data do not carry it.
CompensationModel chosen_model(const CalibrateOptions& options, const Calibration& calibration) {
  if (options.model.empty()) return calibration.models[calibration.recommended].model;
  for (const ModelResult& result : calibration.models) {
    if (options.model != model_name(result.model)) continue;
    if (!result.left_out.empty()) throw DataError(options.model + " cannot be fitted: " + result.left_out);
    return result.model;
  }
  throw UsageError("--model: \"" + options.model +
                   "\" is none of none, offset, A_p, A_simple, A_ind, A_m, A_full");
}

/// One temperature tells nothing about temperature: the person must say that this is enough.
void require_temperatures(const CalibrateOptions& options, const AlignedLogs& logs,
                          const Calibration& calibration) {
  const ModelResult& simple = calibration.model(CompensationModel::kSimple);
  if (options.pressure_only || simple.left_out.empty()) return;
  throw DataError(
      (logs.has_temperature ? simple.left_out : "the sensor's log has no temperature") +
      std::string(": record the sensor at other temperatures as well, or pass --pressure-only to fit "
                  "what does not need them"));
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
         " Pa, p95 |r| " + fixed(result.residual.p95_abs_pa, 2) +
         " Pa; on data that the fit did not know, rms " + fixed(result.cross_validated_rms_pa, 2) +
         " Pa.\nTo use it, name this file in isobar.toml: " +
         "barometer.compensation_file for the robot's sensor, base_barometer.compensation_file for the base "
         "station's. Or put the section there as [barometer.compensation].";
}

void print_lines(const char* before, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::printf("%s%s\n", before, line.c_str());
}

void run(CalibrateOptions options, const std::string& command) {
  options.logs.window_s = 3600.0 * options.window_h;
  Progress progress("reading and fitting");
  report::CalibrationReport page;
  const AlignedLogs logs = align_logs(options.logs);
  progress.update(0.5);
  page.calibration = calibrate(logs.recordings);
  const Calibration& calibration = page.calibration;
  require_temperatures(options, logs, calibration);
  page.chosen = chosen_model(options, calibration);
  progress.finish();
  print_lines("", logs.notes);
  std::printf("\n%s", report::calibration_table(calibration, logs.recordings).c_str());
  print_lines("warning: ", logs.warnings);
  print_lines("warning: ", calibration.warnings);
  if (!options.out.empty()) {
    files::write_text_file(options.out, show_compensation(calibration.config(page.chosen),
                                                          file_comment(options, calibration, page.chosen)));
    std::printf("written: %s (%s)\n", options.out.c_str(), model_name(page.chosen));
  }
  if (options.report.empty()) return;
  page.title = options.title.empty() ? "Calibration of a barometer" : options.title;
  page.command = command;
  page.recordings = logs.recordings;
  page.notes = logs.notes;
  page.warnings = logs.warnings;
  files::write_text_file(options.report, report::render_calibration_report(page));
  std::printf("report: %s\n", options.report.c_str());
}

void add_columns(CLI::App& command, const std::string& role, recording::PressureColumns& columns) {
  const std::string of = " of the " + role + "'s logs; found by its name if there is one only";
  command.add_option("--" + role + "-pressure", columns.pressure, "pressure column" + of);
  command.add_option("--" + role + "-time", columns.time, "time column" + of);
  command
      .add_option("--" + role + "-unit", columns.pressure_unit,
                  "unit of that pressure; without it the header or the values must tell")
      ->option_text("Pa|hPa|mbar|kPa");
  command
      .add_option("--" + role + "-time-unit", columns.time_unit,
                  "unit of that time where it is a number; without it the header or the values must tell")
      ->option_text("ns|us|ms|s");
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Fit a barometer's compensation to a reference beside it");
  command->footer(
      "Logs are CSV files with a line that names the columns: time (dates, or a number), pressure, "
      "temperature\n"
      "of the sensor. A recording's barometer.csv will do. What was taken for what is printed first.\n\n"
      "  isobar calibrate --sensor cold.csv warm.csv --reference station.csv --out dps310.toml\n\n"
      "then, in isobar.toml:  barometer.compensation_file = \"dps310.toml\"");
  command
      ->add_option("--sensor", options->logs.sensor.files,
                   "logs of the sensor, one or more; each is a recording")
      ->required();
  command
      ->add_option("--reference", options->logs.reference.files,
                   "logs of the reference, one or more; together they are one log")
      ->required();
  command->add_flag(
      "--paired", options->logs.paired,
      "the first sensor log belongs to the first reference log, and so on, each pair with its own clocks");
  add_columns(*command, "sensor", options->logs.sensor.columns);
  command->add_option(
      "--sensor-temperature", options->logs.sensor.columns.temperature,
      "temperature column of the sensor's logs [degC]; found by its name if there is one only");
  add_columns(*command, "reference", options->logs.reference.columns);
  options->logs.reference.columns.needs_temperature = false;
  auto* shift = command->add_option("--shift", options->shift_s,
                                    "reference's clock minus sensor's [s]; without it, it is searched");
  command->add_option("--window", options->window_h, "search the shift up to this, both ways [h]")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str()
      ->excludes(shift);
  command->add_option("--model", options->model, "write this model instead of the recommended one")
      ->option_text("offset|A_p|A_simple|A_ind|A_m|A_full");
  command->add_flag("--pressure-only", options->pressure_only,
                    "one temperature is enough: fit offset and A_p, leave out what needs temperatures");
  command->add_option("--out", options->out, "TOML file that isobar.toml can name");
  command->add_option("--report", options->report, "HTML report that opens without a network");
  command->add_option("--title", options->title, "headline of the report");
  command->callback([options, command, shift] {
    if (shift->count() > 0) options->logs.shift_s = options->shift_s;
    run(*options, typed_command(*command));
  });
}

}  // namespace isobar::tools
