// SPDX-License-Identifier: BSD-3-Clause
// `isobar experiment all`: every scenario with several seeds, exact and with mounting errors, all methods.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/names.hpp"
#include "daemon/replay.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "simulation/simulate.hpp"
#include "tools/commands.hpp"
#include "tools/deviation_options.hpp"
#include "tools/experiment_recording.hpp"
#include "tools/method_option.hpp"
#include "tools/number_option.hpp"
#include "tools/report/experiment_table.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

namespace fs = std::filesystem;

struct AllOptions {
  std::vector<std::string> scenarios;
  std::vector<std::uint64_t> seeds{1, 2};
  bool short_form = false;
  simulation::Deviations deviations;
  std::vector<std::string> methods;
  fs::path out = "out";
  fs::path config;
  bool discard = false;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

std::vector<std::string> chosen_scenarios(const std::vector<std::string>& names) {
  std::set<std::string> known;
  std::vector<std::string> usual;
  for (const simulation::ScenarioInfo& info : simulation::scenarios()) {
    known.insert(info.name);
    if (!info.is_long) usual.push_back(info.name);
  }
  if (names.empty()) return usual;
  for (const std::string& name : names) {
    if (!known.contains(name)) {
      throw UsageError("--scenarios: \"" + name + "\" is unknown; `isobar simulate --list` shows all");
    }
  }
  return names;
}

/// Each scenario and seed without and with the mounting errors.
std::vector<simulation::ScenarioRequest> requests_of(const AllOptions& options) {
  std::vector<simulation::ScenarioRequest> requests;
  for (const std::string& name : chosen_scenarios(options.scenarios)) {
    for (const std::uint64_t seed : options.seeds) {
      simulation::ScenarioRequest request;
      request.name = name;
      request.seed = seed;
      request.short_form = options.short_form;
      request.deviations = options.deviations;
      request.deviations.mount_error_deg = 0.0;
      requests.push_back(request);
      if (options.deviations.mount_error_deg == 0.0) continue;
      request.deviations.mount_error_deg = options.deviations.mount_error_deg;
      requests.push_back(request);
    }
  }
  return requests;
}

/// Replays one method into its folder; a failure becomes the message of the cell.
report::ExperimentCell replay_method(const fs::path& recording, Config config, Method method,
                                     const fs::path& folder) {
  report::ExperimentCell cell;
  cell.method = std::string(kMethodNames.name(method));
  config.method = method;
  try {
    const ReplaySummary summary = replay(recording, config, folder / cell.method, [](double) {});
    std::printf("%-36s %-14s %6.1f s of recording in %5.1f s\n", folder.filename().c_str(),
                cell.method.c_str(), summary.recorded_s, summary.wall_s);
  } catch (const std::exception& error) {
    cell.failure = error.what();
    std::printf("%-36s %-14s FAILED: %s\n", folder.filename().c_str(), cell.method.c_str(), error.what());
  }
  return cell;
}

/// Fills the figures of the methods that ran.
void evaluate(const fs::path& recording, const fs::path& folder, report::ExperimentResult& result) {
  std::vector<evaluation::EstimateSource> sources;
  std::vector<report::ExperimentCell*> cells;
  for (report::ExperimentCell& cell : result.cells) {
    if (!cell.failure.empty()) continue;
    sources.push_back({cell.method, folder / cell.method});
    cells.push_back(&cell);
  }
  const evaluation::EvaluatedRun run =
      evaluation::evaluate_methods(evaluation::load_reference(recording), sources);
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i]->figures = run.methods[i].evaluation.figures;
  result.figures_json = report::figures_json(run);
}

/// One recording from simulation to figures.
report::ExperimentResult run_one(const simulation::ScenarioRequest& request, const AllOptions& options,
                                 const Config& config, const std::vector<Method>& methods) {
  report::ExperimentResult result;
  result.recording = simulation::recording_name(request);
  const fs::path folder = options.out / result.recording;
  const fs::path recording = folder / ("recording-" + result.recording);
  try {
    fs::create_directories(folder);
    simulate_if_missing(request, recording, {});
    for (const Method method : methods) {
      result.cells.push_back(replay_method(recording, config, method, folder));
    }
    evaluate(recording, folder, result);
    if (options.discard) fs::remove_all(folder);
  } catch (const std::exception& error) {
    result.failure = error.what();
    result.cells.clear();
    std::printf("%-36s FAILED: %s\n", result.recording.c_str(), error.what());
  }
  return result;
}

/// Runs all recordings, `jobs` at a time; in the order of the requests.
std::vector<report::ExperimentResult> run_recordings(
    const AllOptions& options, const std::vector<simulation::ScenarioRequest>& requests) {
  const Config config = options.config.empty() ? Config{} : load_config(options.config);
  const std::vector<Method> methods = chosen_methods(options.methods);
  std::vector<report::ExperimentResult> results(requests.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < requests.size(); i = next++) {
      results[i] = run_one(requests[i], options, config, methods);
    }
  };
  std::vector<std::jthread> workers;
  for (std::size_t i = 1; i < std::min(options.jobs, requests.size()); ++i) workers.emplace_back(work);
  work();
  workers.clear();
  return results;
}

void run_all(const AllOptions& options, const std::string& command) {
  const std::vector<simulation::ScenarioRequest> requests = requests_of(options);
  std::printf("%zu recordings, %zu at a time\n", requests.size(), std::min(options.jobs, requests.size()));
  const std::vector<report::ExperimentResult> results = run_recordings(options, requests);
  const std::string table = report::experiment_table(results);
  std::printf("\n%s\n", table.c_str());
  fs::create_directories(options.out);
  write_output(options.out / "experiment-all.txt", table);
  write_output(options.out / "experiment-all.json", report::experiment_json(results, command));
  const auto failed = [](const report::ExperimentResult& result) {
    return !result.failure.empty() || std::any_of(result.cells.begin(), result.cells.end(),
                                                  [](const auto& cell) { return !cell.failure.empty(); });
  };
  const auto count = std::count_if(results.begin(), results.end(), failed);
  if (count > 0)
    throw DataError(std::to_string(count) + " recordings failed, in whole or in part: see above");
}

}  // namespace

void add_experiment_all_command(CLI::App& experiment) {
  const auto [command, options] = add_subcommand<AllOptions>(
      experiment, "all", "Every scenario with several seeds and all methods, in one table", run_all);
  options.deviations.mount_error_deg = 0.5;
  command
      .add_option("--scenarios", options.scenarios,
                  "names (default: all but city-10km, city-hour and four-floors)")
      ->delimiter(',');
  command.add_option("--seeds", options.seeds, "random seeds of world and sensor errors")
      ->delimiter(',')
      ->capture_default_str();
  command.add_flag("--short", options.short_form, "the short forms of the scenarios");
  command.add_option("--methods", options.methods, method_names() + " (default: all)")->delimiter(',');
  command
      .add_option("--out", options.out,
                  "folder for experiment-all.txt, experiment-all.json and a folder a recording")
      ->capture_default_str();
  command.add_option("--config", options.config, "TOML file with the estimator's settings");
  command.add_flag(
      "--discard", options.discard,
      "delete recordings and runs after their figures are taken: a full recording has up to 500 MB");
  command.add_option("--jobs", options.jobs, "recordings at a time")
      ->capture_default_str()
      ->check(number_within(1, 64));
  add_deviation_options(command, options.deviations);
}

}  // namespace isobar::tools
