// SPDX-License-Identifier: BSD-3-Clause
// `isobar experiment`: one of the paper's experiments: simulate, replay with all methods, evaluate.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/names.hpp"
#include "core/nearest_word.hpp"
#include "daemon/replay.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/scenario_list.hpp"
#include "simulation/simulate.hpp"
#include "tools/commands.hpp"
#include "tools/deviation_options.hpp"
#include "tools/experiment_recording.hpp"
#include "tools/floor_comparison.hpp"
#include "tools/lidar_option.hpp"
#include "tools/method_option.hpp"
#include "tools/number_option.hpp"
#include "tools/progress.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/report/report.hpp"
#include "tools/report/terminal_table.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct ExperimentOptions {
  simulation::ScenarioRequest request;
  std::filesystem::path out;
  std::filesystem::path config;
  std::vector<std::string> methods;
  bool corrected = false;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

void simulate_with_progress(const ExperimentOptions& options, const std::filesystem::path& recording) {
  Progress progress("simulating");
  const bool simulated =
      simulate_if_missing(options.request, recording, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  if (!simulated) std::printf("using the existing recording %s\n", recording.c_str());
}

/// Mean progress of several replays on one bar. Thread-safe.
class SharedProgress {
 public:
  explicit SharedProgress(std::size_t count)
      : fractions_(count, 0.0), progress_("replaying " + std::to_string(count) + " methods") {}

  void update(std::size_t index, double fraction) {
    const std::lock_guard lock(mutex_);
    fractions_[index] = fraction;
    const double sum = std::accumulate(fractions_.begin(), fractions_.end(), 0.0);
    progress_.update(sum / static_cast<double>(fractions_.size()));
  }

 private:
  std::mutex mutex_;
  std::vector<double> fractions_;
  Progress progress_;
};

void replay_one(const ExperimentOptions& options, const std::filesystem::path& recording,
                const Config& config, const std::function<void(double)>& report_progress) {
  const std::string name(kMethodNames.name(config.method));
  const ReplaySummary summary = replay(recording, config, options.out / name, report_progress);
  std::printf("%-14s %6.1f s of recording in %5.1f s\n", name.c_str(), summary.recorded_s, summary.wall_s);
}

/// Replays with every method, `jobs` at a time.
/// @throws the first error of any replay, after the running ones have ended
void replay_all(const ExperimentOptions& options, const std::filesystem::path& recording,
                const std::vector<Method>& methods) {
  const Config config = options.config.empty() ? Config{} : load_config(options.config);
  SharedProgress progress(methods.size());
  std::mutex error_mutex;
  std::exception_ptr first_error;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < methods.size(); i = next++) {
      try {
        Config own = config;
        own.method = methods[i];
        replay_one(options, recording, own, [&](double fraction) { progress.update(i, fraction); });
      } catch (...) {
        const std::lock_guard lock(error_mutex);
        if (!first_error) first_error = std::current_exception();
        next = methods.size();
      }
    }
  };
  const std::size_t jobs = std::min(options.jobs, methods.size());
  std::printf("%zu replays at a time\n", jobs);
  std::vector<std::thread> workers;
  for (std::size_t i = 1; i < jobs; ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (first_error) std::rethrow_exception(first_error);
}

std::string title_of(const std::string& scenario) {
  if (scenario == "three-floors") return "Three floors";
  if (scenario == "elevator") return "Elevator";
  if (scenario == "moulin") return "Moulin";
  return scenario;
}

/// " (with mount-error 0.5, base-rate 4)"; empty without deviations.
std::string deviations_text(const simulation::Deviations& deviations) {
  std::string text;
  for (const std::string& option : deviations.options()) text += (text.empty() ? " (with " : ", ") + option;
  return text.empty() ? text : text + ")";
}

void evaluate_all(const ExperimentOptions& options, const std::filesystem::path& recording,
                  const std::vector<Method>& methods, const std::string& command) {
  std::vector<evaluation::EstimateSource> sources;
  for (const Method method : methods) {
    const std::string name(kMethodNames.name(method));
    sources.push_back({name, options.out / name});
  }
  if (options.corrected) evaluation::add_corrected(sources);
  report::ReportInput input;
  input.run = evaluation::evaluate_methods(evaluation::load_reference(recording), sources);
  input.title = title_of(options.request.name) + ", seed " + std::to_string(options.request.seed);
  input.description = "Simulated recording \"" + options.request.name + "\"" +
                      (options.request.short_form ? " in its short form" : "") + ", lidar " +
                      options.request.lidar + deviations_text(options.request.deviations) +
                      ", replayed with each method on the same sensor data.";
  input.command = command;
  report::print_table(stdout, input.run);
  std::printf("\n");
  if (options.request.name == "four-floors") {
    for (const evaluation::EstimateSource& source : sources) {
      print_floor_comparison(source.name.c_str(), compare_floors(input.run.reference, source.path));
    }
  }
  write_output(options.out / "report.html", report::render_report(input));
  write_output(options.out / "figures.json", report::figures_json(input.run));
}

void run_experiment(ExperimentOptions options, const std::string& command) {
  if (options.request.name.empty())
    throw UsageError("SCENARIO: missing; `isobar experiment --help` shows the names");
  const std::string name = simulation::recording_name(options.request);
  if (options.out.empty()) options.out = "out/" + name;
  const std::vector<Method> methods = chosen_methods(options.methods);
  // Before a folder is made for unknown ones.
  (void)simulation::find_scenario(options.request.name);
  (void)simulation::find_lidar_plan(options.request.lidar);
  std::filesystem::create_directories(options.out);
  const std::filesystem::path recording = options.out / ("recording-" + name);
  simulate_with_progress(options, recording);
  replay_all(options, recording, methods);
  evaluate_all(options, recording, methods, command);
}

/// A word beside the scenarios' names that is nearly the name of a subcommand.
CLI::Validator no_misspelt_command(const CLI::App& command) {
  const auto check = [&command](const std::string& word) -> std::string {
    std::vector<std::string> commands;
    for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; }))
      commands.push_back(below->get_name());
    std::vector<std::string> names = commands;
    for (const simulation::ScenarioInfo& scenario : simulation::scenarios()) names.push_back(scenario.name);
    const std::string nearest = nearest_word(word, names);
    const bool is_command = std::find(commands.begin(), commands.end(), nearest) != commands.end();
    return is_command ? "unknown scenario '" + word + "'; did you mean isobar experiment " + nearest + "?"
                      : std::string();
  };
  return {check, "", ""};
}

}  // namespace

void add_experiment_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<ExperimentOptions>(
      app, "experiment", "One of the paper's experiments: simulate, replay with all methods, evaluate",
      run_experiment);
  add_sensitivity_command(command);
  add_experiment_all_command(command);
  add_experiment_sessions_command(command);
  command
      .add_option("SCENARIO", options.request.name,
                  "three-floors, elevator, moulin; `isobar simulate --list` shows all")
      ->check(no_misspelt_command(command));
  command.add_option("--seed", options.request.seed, "random seed of world and sensor errors")
      ->capture_default_str()
      ->check(number_from_zero());
  command.add_flag("--short", options.request.short_form, "the short form of the scenario");
  add_lidar_option(command, options.request);
  command.add_option(
      "--out", options.out,
      "folder for recording, runs and report (default: out/SCENARIO-SEED and the faults asked for)");
  command.add_option("--config", options.config, "TOML file with the estimator's settings");
  command.add_option("--methods", options.methods, method_names() + " (default: all)")->delimiter(',');
  command.add_flag("--corrected", options.corrected,
                   "evaluate the trajectory of each run as its loops correct it as well");
  command.add_option("--jobs", options.jobs, "replays at a time")
      ->capture_default_str()
      ->check(number_within(1, 64));
  add_deviation_options(command, options.request.deviations);
}

}  // namespace isobar::tools
