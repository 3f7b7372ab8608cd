// SPDX-License-Identifier: BSD-3-Clause
// `isobar experiment sensitivity`: errors of two barometers over height steps, simulated or recorded.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/errors.hpp"
#include "core/stamp.hpp"
#include "simulation/sensitivity_rig.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/pressure_log.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/number_text.hpp"
#include "tools/report/sensitivity_report.hpp"
#include "tools/sensitivity_recording.hpp"
#include "tools/sensitivity_study.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

using report::ErrorRow;
using report::SensitivityExperiment;

struct SensitivityArguments {
  std::uint64_t seed = 1;
  int runs = 20;
  double dwell_s = 30.0;
  double distance_m = 1.0;
  RecordedRigRequest request;  ///< step, steps, lag and settling time also apply to simulated rigs
  std::filesystem::path out;
};

/// The row of a sensor and kind of error, added if missing.
ErrorRow& row_of(SensitivityExperiment& experiment, const std::string& sensor, bool filtered,
                 bool plateau_means) {
  const auto row = std::find_if(experiment.rows.begin(), experiment.rows.end(), [&](const ErrorRow& r) {
    return r.sensor == sensor && r.filtered == filtered && r.plateau_means == plateau_means;
  });
  if (row != experiment.rows.end()) return *row;
  return experiment.rows.emplace_back(ErrorRow{sensor, filtered, plateau_means, {}, {}});
}

/// Adds one run of one sensor pair to the sensor's four rows.
void add_errors(SensitivityExperiment& experiment, const SensorStudy& study) {
  const auto add = [&](bool filtered, bool means, const std::vector<double>& errors_m) {
    ErrorRow& row = row_of(experiment, study.name, filtered, means);
    row.errors_m.insert(row.errors_m.end(), errors_m.begin(), errors_m.end());
    row.runs.push_back(error_figures(errors_m));
  };
  add(false, false, study.raw_errors.samples_m);
  add(true, false, study.filtered_errors.samples_m);
  add(false, true, study.raw_errors.steps_m);
  add(true, true, study.filtered_errors.steps_m);
}

void add_picture(SensitivityExperiment& experiment, SensorStudy study) {
  experiment.pictures.push_back({std::move(study.name), std::move(study.raw), std::move(study.filtered),
                                 std::move(study.plateaus), study.lag_s});
}

std::string number_word(std::size_t count) {
  return count == 10 ? "Ten" : count == 5 ? "Five" : std::to_string(count);
}

std::string steps_title(std::size_t count, double step_m) {
  const double step_cm = std::round(1e3 * step_m) / 10.0;
  return number_word(count) + " steps of " + report::fixed(step_cm, step_cm == std::round(step_cm) ? 0 : 1) +
         " cm";
}

/// One simulated run of both sensor pairs; the first run gives the pictures.
void add_simulated_run(SensitivityExperiment& experiment, const simulation::RigRequest& request,
                       StudyOptions options, bool with_pictures) {
  simulation::RigRun rig = simulation::simulate_rig(request);
  options.air_temperature_k = rig.air_temperature_c + kZeroCelsiusK;
  for (auto& [name, pair] : {std::pair{"DPS310", &rig.dps310}, std::pair{"Setra 278", &rig.ceramic}}) {
    const BarometerPair both{name, std::move(pair->moved), std::move(pair->standing)};
    std::vector<double> step_times_s;
    for (const std::int64_t move_ns : rig.moves_ns) {
      step_times_s.push_back(seconds_between(both.moved.front().stamp_ns, move_ns));
    }
    SensorStudy study = study_pair(both, step_times_s, options);
    add_errors(experiment, study);
    if (with_pictures) add_picture(experiment, std::move(study));
  }
}

SensitivityExperiment simulate(const SensitivityArguments& arguments, double step_m, int steps) {
  StudyOptions options;
  options.step_m = step_m;
  options.lag_s = arguments.request.lag_s;
  options.settle_s = arguments.request.settle_s.value_or(options.settle_s);
  simulation::RigRequest request;
  request.step_m = step_m;
  request.steps = steps;
  request.dwell_s = arguments.dwell_s;
  request.distance_m = arguments.distance_m;
  SensitivityExperiment experiment;
  for (int run = 0; run < arguments.runs; ++run) {
    request.seed = arguments.seed + static_cast<std::uint64_t>(run);
    add_simulated_run(experiment, request, options, run == 0);
  }
  experiment.title = steps_title(static_cast<std::size_t>(steps), step_m);
  experiment.caption = "Simulated: " + std::to_string(arguments.runs) + " runs from seed " +
                       std::to_string(arguments.seed) + ", " + report::fixed(arguments.dwell_s, 0) +
                       " s on each level, rigs " + report::fixed(arguments.distance_m, 1) +
                       " m apart. The pictures show the first run.";
  return experiment;
}

SensitivityExperiment from_recording(const SensitivityArguments& arguments) {
  if (!arguments.request.step_m) throw UsageError("--step: missing; it is the true height of a step [m]");
  RecordedRig rig = read_recorded_rig(arguments.request);
  for (const std::string& note : rig.notes) std::printf("%s\n", note.c_str());
  SensitivityExperiment experiment;
  experiment.title = steps_title(rig.plateaus.size() - 1, rig.options.step_m);
  SensorStudy study = study_pair(rig.pair, std::move(rig.plateaus), rig.options);
  if (study.raw_errors.steps_m.empty()) {
    throw DataError(arguments.request.recording.string() + ": fewer than two levels have samples");
  }
  experiment.caption = rig.moved_file.string() + " against " + rig.standing_file.string() + ", air at " +
                       report::fixed(rig.options.air_temperature_k - kZeroCelsiusK, 1) + " °C; white noise " +
                       report::fixed(study.sigma_pa, 2) + " Pa per sample, " +
                       report::fixed(study.output_sigma_pa, 3) + " Pa after the low-pass.";
  add_errors(experiment, study);
  add_picture(experiment, std::move(study));
  return experiment;
}

void print_experiment(const SensitivityExperiment& experiment) {
  std::printf("\n%s. %s\n", experiment.title.c_str(), experiment.caption.c_str());
  std::vector<report::Cells> rows{{"|steady-state error| [cm]", "median", "sd", "worst run: median", "sd"}};
  const auto cm = [](double value_m) { return report::fixed(100.0 * value_m, 2); };
  for (const ErrorRow& row : experiment.rows) {
    const report::OverRuns median = over_runs(row, &ErrorFigures::median_m);
    const report::OverRuns sd = over_runs(row, &ErrorFigures::sd_m);
    rows.push_back({row.sensor + ", " + row_name(row), cm(median.median_m), cm(sd.median_m),
                    cm(median.worst_m), cm(sd.worst_m)});
  }
  std::printf("%s", report::aligned_rows(rows).c_str());
}

/// The error of every level as CSV.
std::string errors_csv(const report::SensitivityReport& page) {
  std::string text = "experiment,sensor,filtered,run,step,error_m\n";
  for (const SensitivityExperiment& experiment : page.experiments) {
    for (const ErrorRow& row : experiment.rows) {
      if (!row.plateau_means) continue;
      std::size_t next = 0;
      for (std::size_t run = 0; run < row.runs.size(); ++run) {
        for (std::size_t step = 1; step <= row.runs[run].count; ++step) {
          text += experiment.title + "," + row.sensor + (row.filtered ? ",1," : ",0,") +
                  std::to_string(run + 1) + "," + std::to_string(step) + "," +
                  report::fixed(row.errors_m[next++], 6) + "\n";
        }
      }
    }
  }
  return text;
}

report::SensitivityReport simulated_report(const SensitivityArguments& arguments) {
  report::SensitivityReport page;
  page.description =
      "Two rigs, each with a DPS310 (MEMS) and a Setra 278 (ceramic): one is lifted in steps, the other "
      "stands. Simulated with weather, turbulence between the rigs, offsets, flicker noise and warm-up.";
  if (arguments.request.step_m) {
    const int steps = arguments.request.steps > 0 ? static_cast<int>(arguments.request.steps) : 10;
    page.experiments.push_back(simulate(arguments, *arguments.request.step_m, steps));
  } else {
    page.experiments.push_back(simulate(arguments, 0.13, 5));
    page.experiments.push_back(simulate(arguments, 0.03, 10));
  }
  return page;
}

report::SensitivityReport recorded_report(const SensitivityArguments& arguments) {
  report::SensitivityReport page;
  page.description = "Two recorded barometers: one was lifted in steps of known height, the other stood.";
  page.experiments.push_back(from_recording(arguments));
  return page;
}

std::filesystem::path folder_of(const SensitivityArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  return arguments.request.recording.empty() ? "out/sensitivity-" + std::to_string(arguments.seed)
                                             : "out/sensitivity";
}

void run_sensitivity(const SensitivityArguments& arguments, const std::string& command) {
  report::SensitivityReport page =
      arguments.request.recording.empty() ? simulated_report(arguments) : recorded_report(arguments);
  page.title = "Sensitivity: steps of known height";
  page.command = command;
  for (const SensitivityExperiment& experiment : page.experiments) print_experiment(experiment);
  std::printf("\n");
  const std::filesystem::path folder = folder_of(arguments);
  std::filesystem::create_directories(folder);
  write_output(folder / "report.html", render_sensitivity_report(page));
  write_output(folder / "errors.csv", errors_csv(page));
}

/// Options of the simulated rigs.
void add_simulation_options(CLI::App& command, SensitivityArguments& options) {
  command.add_option("--seed", options.seed, "random seed of the first simulated run")
      ->capture_default_str()
      ->check(number_from_zero());
  command.add_option("--runs", options.runs, "simulated runs, each with the next seed")
      ->capture_default_str()
      ->check(number_within(1, 1000));
  command.add_option("--dwell", options.dwell_s, "simulated time on each level [s]")
      ->capture_default_str()
      ->check(number_within(4.0, 600.0));
  command
      .add_option("--distance", options.distance_m,
                  "distance of the simulated rigs [m]; from 4 m on their turbulence is independent")
      ->capture_default_str()
      ->check(number_within(0.0, 100.0));
}

/// Options of a recorded rig.
void add_recording_options(CLI::App& command, RecordedRigRequest& request) {
  command.add_option(
      "--recording", request.recording,
      "a recorded rig: folder with barometer.csv (moved) and base_barometer.csv (standing), or "
      "the moved barometer's CSV");
  command.add_option("--base", request.base, "CSV of the standing barometer");
  command.add_option("--columns", request.columns, kColumnsHelp);
  command.add_option("--segments", request.segments,
                     "segments.csv with the levels; a label may be the height [m] (default: the folder's, "
                     "otherwise steps are searched)");
  command.add_option("--sensor", request.sensor, "name of the recorded sensor")->capture_default_str();
  add_air_option(command, request.air_c);
}

}  // namespace

void add_sensitivity_command(CLI::App& experiment) {
  const auto [command, options] = add_subcommand<SensitivityArguments>(
      experiment, "sensitivity",
      "Steps of 13 and 3 cm, MEMS and ceramic barometers; simulated, or a recorded rig", run_sensitivity);
  RecordedRigRequest& request = options.request;
  add_simulation_options(command, options);
  add_recording_options(command, request);
  command.add_option("--step", request.step_m, "true height of a step [m]")->check(number_above_zero());
  command.add_option("--steps", request.steps, "number of steps (default: all that are found)");
  command
      .add_option("--lag", request.lag_s,
                  "lag of the low-pass [s] (default: a tenth of the shortest level, at most 3)")
      ->check(number_above_zero());
  command.add_option("--settle", request.settle_s, "time left out before and after each step [s]")
      ->check(number_from_zero());
  command.add_option("--out", options.out, "folder for the report (default: below out/)");
}

}  // namespace isobar::tools
