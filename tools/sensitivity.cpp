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
#include "core/altitude/stamp.hpp"
#include "core/errors.hpp"
#include "core/evaluation/segments.hpp"
#include "core/evaluation/text_table.hpp"
#include "drivers/recording/manifest.hpp"
#include "drivers/simulation/sensitivity_rig.hpp"
#include "tools/commands.hpp"
#include "tools/pressure_log.hpp"
#include "tools/report/sensitivity_report.hpp"
#include "tools/report/svg.hpp"
#include "tools/report/text_file.hpp"
#include "tools/sensitivity_study.hpp"

namespace isobar::tools {

namespace {

using evaluation::ErrorFigures;
using evaluation::Plateau;
using report::ErrorRow;
using report::SensitivityExperiment;

struct SensitivityArguments {
  std::uint64_t seed = 1;
  int runs = 20;
  double dwell_s = 30.0;
  double distance_m = 1.0;
  std::filesystem::path recording;
  std::filesystem::path base;
  std::filesystem::path segments;
  std::string columns;
  std::string sensor = "recorded";
  std::optional<double> step_m;
  std::size_t steps = 0;
  std::optional<double> lag_s;
  std::optional<double> settle_s;
  std::optional<double> air_c;
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
    row->runs.push_back(evaluation::error_figures(errors_m));
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
  options.lag_s = arguments.lag_s;
  options.settle_s = arguments.settle_s.value_or(options.settle_s);
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

/// Where a recording's two logs are.
struct Files {
  std::filesystem::path moved;
  std::filesystem::path standing;
  std::filesystem::path segments;  ///< may be empty
};

Files files_of(const SensitivityArguments& arguments) {
  namespace fs = std::filesystem;
  Files files{arguments.recording, arguments.base, arguments.segments};
  if (!fs::exists(files.moved)) throw DataError(files.moved.string() + ": no such file or folder");
  if (fs::is_directory(arguments.recording)) {
    files.moved = arguments.recording / "barometer.csv";
    if (files.standing.empty()) files.standing = arguments.recording / "base_barometer.csv";
    const fs::path segments = arguments.recording / recording::kSegmentsFile;
    if (files.segments.empty() && fs::exists(segments)) files.segments = segments;
  }
  if (files.standing.empty()) {
    throw UsageError("--base: the standing barometer's file is missing; the experiment compares two");
  }
  return files;
}

BarometerPair read_pair(const SensitivityArguments& arguments, const Files& files) {
  const PressureColumns columns =
      arguments.columns.empty() ? PressureColumns{} : parse_columns(arguments.columns);
  PressureLog moved = read_pressure_log(files.moved, columns);
  PressureLog standing = read_pressure_log(files.standing, columns);
  for (const auto& [file, log] : {std::pair{&files.moved, &moved}, std::pair{&files.standing, &standing}}) {
    if (log->samples.size() < 100)
      throw DataError(file->string() + ": fewer than 100 samples are no experiment");
    const std::string rest = left_out(*log);
    if (!rest.empty()) std::printf("%s: %s\n", file->c_str(), rest.c_str());
  }
  std::printf("clocks: %s\n", tie_clocks(moved, standing).c_str());
  return {arguments.sensor, std::move(moved.samples), std::move(standing.samples)};
}

/// Levels that segments.csv names; a label that is a number is the level's true height in metres.
std::vector<Plateau> named_plateaus(const std::filesystem::path& file, const BarometerPair& pair,
                                    const StudyOptions& options) {
  const auto segments = evaluation::parse_segments_csv(report::read_text_file(file), file.string());
  if (segments.size() < 2) throw DataError(file.string() + ": names fewer than two levels");
  std::vector<Plateau> plateaus;
  std::vector<double> middles_s;
  bool heights_known = true;
  for (const evaluation::Segment& segment : segments) {
    const auto seconds = [&](std::int64_t stamp_ns) {
      return seconds_between(pair.moved.front().stamp_ns, stamp_ns);
    };
    const std::optional<double> height_m = evaluation::parse_double(segment.label);
    heights_known = heights_known && height_m.has_value();
    if (!plateaus.empty()) middles_s.push_back(0.5 * (plateaus.back().end_s + seconds(segment.start_ns)));
    plateaus.push_back({seconds(segment.start_ns), seconds(segment.end_ns), height_m.value_or(0.0)});
  }
  if (heights_known) return plateaus;
  const auto between =
      plateaus_between(raw_track(pair, options.air_temperature_k), middles_s, options.step_m, 0.0, 0.0);
  for (std::size_t i = 0; i < plateaus.size(); ++i) plateaus[i].true_height_m = between[i].true_height_m;
  return plateaus;
}

/// What does not count on both sides of a step that was found, to some tenths of a second: a share of the
/// time on a level, so that enough is left of short ones.
double found_settle_s(const std::vector<double>& step_times_s) {
  if (step_times_s.size() < 2) return 1.5;
  const double dwell_s =
      (step_times_s.back() - step_times_s.front()) / static_cast<double>(step_times_s.size() - 1);
  return std::clamp(0.15 * dwell_s, 0.5, 1.5);
}

/// Levels that the heights themselves show.
std::vector<Plateau> found_plateaus(const SensitivityArguments& arguments, const BarometerPair& pair,
                                    const StudyOptions& options) {
  const evaluation::HeightTrack track = raw_track(pair, options.air_temperature_k);
  evaluation::StepSearch search;
  search.step_m = options.step_m;
  search.steps = arguments.steps;
  const evaluation::FoundSteps found = find_steps(track, search);
  constexpr double kTooUncertainS = 2.0;
  const std::string advice = "; name the levels with --segments (t_start_ns,t_end_ns,label)";
  if (found.uncertainty_s > kTooUncertainS) {
    throw DataError(arguments.recording.string() + ": steps of " + report::fixed(100.0 * options.step_m, 1) +
                    " cm cannot be found in this noise (to " + report::fixed(found.uncertainty_s, 1) + " s)" +
                    advice);
  }
  if (found.times_s.empty() || (arguments.steps > 0 && found.times_s.size() != arguments.steps)) {
    throw DataError(arguments.recording.string() + ": " + std::to_string(found.times_s.size()) +
                    " steps of this height were found" + advice);
  }
  std::printf("%zu steps found, each to %.2f s:", found.times_s.size(), found.uncertainty_s);
  for (const double time_s : found.times_s) std::printf(" %.1f", time_s);
  std::printf(" s\n");
  const double settle_s = arguments.settle_s.value_or(found_settle_s(found.times_s));
  return plateaus_between(track, found.times_s, options.step_m, settle_s, settle_s);
}

SensitivityExperiment from_recording(const SensitivityArguments& arguments) {
  if (!arguments.step_m) throw UsageError("--step: the true height of a step [m] is missing");
  const Files files = files_of(arguments);
  const BarometerPair pair = read_pair(arguments, files);
  StudyOptions options;
  options.step_m = *arguments.step_m;
  options.lag_s = arguments.lag_s;
  options.settle_s = arguments.settle_s.value_or(0.0);
  options.air_temperature_k =
      arguments.air_c.value_or(coldest_c({&pair.moved, &pair.standing}).value_or(20.0)) + kZeroCelsiusK;
  std::vector<Plateau> plateaus =
      files.segments.empty()
          ? found_plateaus(arguments, pair, options)
          : shortened(named_plateaus(files.segments, pair, options), options.settle_s, options.settle_s);
  SensitivityExperiment experiment;
  experiment.title = steps_title(plateaus.size() - 1, options.step_m);
  SensorStudy study = study_pair(pair, std::move(plateaus), options);
  experiment.caption = files.moved.string() + " against " + files.standing.string() + ", air at " +
                       report::fixed(options.air_temperature_k - kZeroCelsiusK, 1) + " °C; white noise " +
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

std::string typed_command(const SensitivityArguments& arguments) {
  std::string command = "isobar experiment sensitivity";
  if (arguments.recording.empty()) {
    command += " --seed " + std::to_string(arguments.seed) + " --runs " + std::to_string(arguments.runs) +
               " --dwell " + report::fixed(arguments.dwell_s, 0) + " --distance " +
               report::fixed(arguments.distance_m, 1);
  } else {
    command += " --recording " + arguments.recording.string();
    if (!arguments.base.empty()) command += " --base " + arguments.base.string();
    if (!arguments.segments.empty()) command += " --segments " + arguments.segments.string();
    if (!arguments.columns.empty()) command += " --columns '" + arguments.columns + "'";
    if (arguments.steps > 0) command += " --steps " + std::to_string(arguments.steps);
  }
  if (arguments.step_m) command += " --step " + report::fixed(*arguments.step_m, 3);
  if (arguments.lag_s) command += " --lag " + report::fixed(*arguments.lag_s, 2);
  return command + " --out " + arguments.out.string();
}

void run(SensitivityArguments arguments) {
  report::SensitivityReport page;
  page.title = "Sensitivity: steps of known height";
  if (arguments.recording.empty()) {
    if (arguments.out.empty()) arguments.out = "out/sensitivity-" + std::to_string(arguments.seed);
    page.description =
        "Two rigs, each with a DPS310 (MEMS) and a Setra 278 (ceramic): one is lifted in steps, the other "
        "stands. Simulated with weather, turbulence between the rigs, offsets, flicker and warm-up.";
    if (arguments.step_m) {
      page.experiments.push_back(simulate(arguments, *arguments.step_m,
                                          arguments.steps > 0 ? static_cast<int>(arguments.steps) : 10));
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
  report::write_text_file(file, render_sensitivity_report(page));
  std::printf("\nreport: %s\n", file.c_str());
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
  command->add_option("--recording", arguments->recording,
                      "a real rig: a folder with barometer.csv (moved) and base_barometer.csv (standing), or "
                      "the moved one's CSV");
  command->add_option("--base", arguments->base, "CSV of the standing barometer");
  command->add_option("--columns", arguments->columns, kColumnsHelp);
  command->add_option(
      "--segments", arguments->segments,
      "segments.csv that names the levels, their heights in m as labels if you like (default: "
      "the folder's, else steps are found)");
  command->add_option("--sensor", arguments->sensor, "the recorded sensors' name")->capture_default_str();
  command->add_option("--step", arguments->step_m, "true height of a step [m]")->check(CLI::PositiveNumber);
  command->add_option("--steps", arguments->steps, "how many steps there are (default: as many as are seen)");
  command
      ->add_option("--lag", arguments->lag_s,
                   "lag of the low-pass [s] (default: a tenth of the shortest level, at most 3)")
      ->check(CLI::PositiveNumber);
  command->add_option("--settle", arguments->settle_s, "time on both sides of a step that does not count [s]")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--air", arguments->air_c, "air temperature [degC] (default: the colder barometer's)")
      ->check(CLI::Range(-60.0, 60.0));
  command->add_option("--out", arguments->out, "folder for the report");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace isobar::tools
