// SPDX-License-Identifier: BSD-3-Clause
// `isobar experiment sensitivity`: the smallest steps that two barometers can tell, simulated or from a rig.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/errors.hpp"
#include "core/stamp.hpp"
#include "run/files/text_file.hpp"
#include "simulation/sensitivity_rig.hpp"
#include "tools/commands.hpp"
#include "tools/pressure_log.hpp"
#include "tools/report/sensitivity_report.hpp"
#include "tools/report/svg.hpp"
#include "tools/sensitivity_recording.hpp"
#include "tools/sensitivity_study.hpp"

namespace isobar::tools {

namespace {

using report::ErrorRow;
using report::SensitivityExperiment;

struct SensitivityArguments {
  std::uint64_t seed = 1;
  int runs = 20;
  double dwell_s = 30.0;
  double distance_m = 1.0;
  RecordedRigRequest request;  ///< step, steps, lag and settling time are those of the simulator, too
  std::filesystem::path out;
};

/// Adds one run of one pair to the rows of its sensor, of which there are four.
void add_errors(SensitivityExperiment& experiment, const SensorStudy& study) {
  const auto add = [&](bool filtered, bool means, const std::vector<double>& errors_m) {
    auto row = std::find_if(experiment.rows.begin(), experiment.rows.end(), [&](const ErrorRow& r) {
      return r.sensor == study.name && r.filtered == filtered && r.plateau_means == means;
    });
    if (row == experiment.rows.end()) {
      row = experiment.rows.insert(row, ErrorRow{study.name, filtered, means, {}, {}});
    }
    row->errors_m.insert(row->errors_m.end(), errors_m.begin(), errors_m.end());
    row->runs.push_back(error_figures(errors_m));
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

SensitivityExperiment simulate(const SensitivityArguments& arguments, double step_m, int steps) {
  SensitivityExperiment experiment;
  StudyOptions options;
  options.step_m = step_m;
  options.lag_s = arguments.request.lag_s;
  options.settle_s = arguments.request.settle_s.value_or(options.settle_s);
  for (int run = 0; run < arguments.runs; ++run) {
    simulation::RigRequest request;
    request.seed = arguments.seed + static_cast<std::uint64_t>(run);
    request.step_m = step_m;
    request.steps = steps;
    request.dwell_s = arguments.dwell_s;
    request.distance_m = arguments.distance_m;
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
      if (run == 0) add_picture(experiment, std::move(study));
    }
  }
  experiment.title = steps_title(static_cast<std::size_t>(steps), step_m);
  experiment.caption = "Simulated, " + std::to_string(arguments.runs) + " runs from seed " +
                       std::to_string(arguments.seed) + ", " + report::fixed(arguments.dwell_s, 0) +
                       " s on each level, rigs " + report::fixed(arguments.distance_m, 1) +
                       " m apart. The pictures show the first run.";
  return experiment;
}

SensitivityExperiment from_recording(const SensitivityArguments& arguments) {
  if (!arguments.request.step_m) throw UsageError("--step: the true height of a step [m] is missing");
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
                       report::fixed(study.sigma_pa, 2) + " Pa a sample, " +
                       report::fixed(study.output_sigma_pa, 3) + " Pa after the low-pass.";
  add_errors(experiment, study);
  add_picture(experiment, std::move(study));
  return experiment;
}

void print_experiment(const SensitivityExperiment& experiment) {
  std::printf("\n%s. %s\n", experiment.title.c_str(), experiment.caption.c_str());
  std::printf("|steady-state error| [cm]%32s  median    sd   worst run: median    sd\n", "");
  for (const ErrorRow& row : experiment.rows) {
    const report::OverRuns median = over_runs(row, &ErrorFigures::median_m);
    const report::OverRuns sd = over_runs(row, &ErrorFigures::sd_m);
    std::printf("  %-54s %7.2f %5.2f  %18.2f %5.2f\n", (row.sensor + ", " + row_name(row)).c_str(),
                100.0 * median.median_m, 100.0 * sd.median_m, 100.0 * median.worst_m, 100.0 * sd.worst_m);
  }
}

/// Every level's error, for other tools.
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

std::string typed_command(const SensitivityArguments& arguments) {
  std::string command = "isobar experiment sensitivity";
  if (arguments.request.recording.empty()) {
    command += " --seed " + std::to_string(arguments.seed) + " --runs " + std::to_string(arguments.runs) +
               " --dwell " + report::fixed(arguments.dwell_s, 0) + " --distance " +
               report::fixed(arguments.distance_m, 1);
  } else {
    command += " --recording " + arguments.request.recording.string();
    if (!arguments.request.base.empty()) command += " --base " + arguments.request.base.string();
    if (!arguments.request.segments.empty()) command += " --segments " + arguments.request.segments.string();
    if (!arguments.request.columns.empty()) command += " --columns '" + arguments.request.columns + "'";
    if (arguments.request.steps > 0) command += " --steps " + std::to_string(arguments.request.steps);
  }
  if (arguments.request.step_m) command += " --step " + report::fixed(*arguments.request.step_m, 3);
  if (arguments.request.lag_s) command += " --lag " + report::fixed(*arguments.request.lag_s, 2);
  return command + " --out " + arguments.out.string();
}

void run(SensitivityArguments arguments) {
  report::SensitivityReport page;
  page.title = "Sensitivity: steps of known height";
  if (arguments.request.recording.empty()) {
    if (arguments.out.empty()) arguments.out = "out/sensitivity-" + std::to_string(arguments.seed);
    page.description =
        "Two rigs, each with a DPS310 (MEMS) and a Setra 278 (ceramic): one is lifted in steps, the other "
        "stands. Simulated with weather, turbulence between the rigs, offsets, flicker and warm-up.";
    if (arguments.request.step_m) {
      page.experiments.push_back(
          simulate(arguments, *arguments.request.step_m,
                   arguments.request.steps > 0 ? static_cast<int>(arguments.request.steps) : 10));
    } else {
      page.experiments.push_back(simulate(arguments, 0.13, 5));
      page.experiments.push_back(simulate(arguments, 0.03, 10));
    }
  } else {
    if (arguments.out.empty()) arguments.out = "out/sensitivity";
    page.description = "Two recorded barometers: one was lifted in steps of known height, the other stood.";
    page.experiments.push_back(from_recording(arguments));
  }
  for (const SensitivityExperiment& experiment : page.experiments) print_experiment(experiment);
  page.command = typed_command(arguments);
  std::filesystem::create_directories(arguments.out);
  const std::filesystem::path file = arguments.out / "report.html";
  files::write_text_file(file, render_sensitivity_report(page));
  files::write_text_file(arguments.out / "errors.csv", errors_csv(page));
  std::printf("\nwritten: %s errors.csv\n", file.c_str());
}

}  // namespace

void add_sensitivity_command(CLI::App& experiment) {
  auto arguments = std::make_shared<SensitivityArguments>();
  CLI::App* command = experiment.add_subcommand(
      "sensitivity", "Steps of 13 and 3 cm, MEMS and ceramic barometers; simulated, or a recorded rig");
  command->add_option("--seed", arguments->seed, "of the first simulated run")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--runs", arguments->runs, "simulated runs, each from the next seed")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_option("--dwell", arguments->dwell_s, "simulated time on each level [s]")
      ->capture_default_str()
      ->check(CLI::Range(4.0, 600.0));
  command
      ->add_option("--distance", arguments->distance_m,
                   "between the simulated rigs [m]; from 4 m on their turbulence is independent")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--recording", arguments->request.recording,
                      "a real rig: a folder with barometer.csv (moved) and base_barometer.csv (standing), or "
                      "the moved one's CSV");
  command->add_option("--base", arguments->request.base, "CSV of the standing barometer");
  command->add_option("--columns", arguments->request.columns, kColumnsHelp);
  command->add_option(
      "--segments", arguments->request.segments,
      "segments.csv that names the levels, their heights in m as labels if you like (default: "
      "the folder's, else steps are found)");
  command->add_option("--sensor", arguments->request.sensor, "the recorded sensors' name")
      ->capture_default_str();
  command->add_option("--step", arguments->request.step_m, "true height of a step [m]")
      ->check(CLI::PositiveNumber);
  command->add_option("--steps", arguments->request.steps,
                      "how many steps there are (default: as many as are seen)");
  command
      ->add_option("--lag", arguments->request.lag_s,
                   "lag of the low-pass [s] (default: a tenth of the shortest level, at most 3)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--settle", arguments->request.settle_s,
                   "time on both sides of a step that does not count [s]")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--air", arguments->request.air_c,
                   "air temperature [degC] (default: the colder barometer's)")
      ->check(CLI::Range(-60.0, 60.0));
  command->add_option("--out", arguments->out, "folder for the report");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace isobar::tools
