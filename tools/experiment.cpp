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
#include "daemon/replay.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/recording/manifest.hpp"
#include "simulation/simulate.hpp"
#include "tools/commands.hpp"
#include "tools/method_option.hpp"
#include "tools/progress.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/report/report.hpp"
#include "tools/report/terminal_table.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct ExperimentOptions {
  std::string scenario;
  std::uint64_t seed = 1;
  bool short_form = false;
  std::filesystem::path out;
  std::filesystem::path config;
  std::vector<std::string> methods;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

std::vector<Method> chosen_methods(const ExperimentOptions& options) {
  if (options.methods.empty()) return {kAllMethods.begin(), kAllMethods.end()};
  std::vector<Method> methods;
  for (const std::string& name : options.methods) {
    const auto method = kMethodNames.value(name);
    if (!method) throw UsageError("--methods: \"" + name + "\" is none of " + method_names());
    methods.push_back(*method);
  }
  return methods;
}

void simulate_if_missing(const ExperimentOptions& options, const std::filesystem::path& recording) {
  if (std::filesystem::exists(recording / recording::kManifestFile)) {
    std::printf("using the existing recording %s\n", recording.c_str());
    return;
  }
  // Renamed when complete, so that an interrupted simulation is not taken for a recording.
  const std::filesystem::path unfinished = recording.string() + ".unfinished";
  std::filesystem::remove_all(unfinished);
  Progress progress("simulating");
  simulation::simulate({options.scenario, options.seed, options.short_form}, unfinished,
                       [&](double fraction) { progress.update(fraction); });
  progress.finish();
  std::filesystem::rename(unfinished, recording);
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

void evaluate_all(const ExperimentOptions& options, const std::filesystem::path& recording,
                  const std::vector<Method>& methods, const std::string& command) {
  std::vector<evaluation::EstimateSource> sources;
  for (const Method method : methods) {
    const std::string name(kMethodNames.name(method));
    sources.push_back({name, options.out / name});
  }
  report::ReportInput input;
  input.run = evaluation::evaluate_methods(evaluation::load_reference(recording), sources);
  input.title = title_of(options.scenario) + ", seed " + std::to_string(options.seed);
  input.description = "Simulated recording \"" + options.scenario + "\"" +
                      (options.short_form ? " in its short form" : "") +
                      ", replayed with each method on the same sensor data.";
  input.command = command;
  report::print_table(stdout, input.run);
  std::printf("\n");
  write_output(options.out / "report.html", report::render_report(input));
  write_output(options.out / "figures.json", report::figures_json(input.run));
  write_output(options.out / "overview.svg", report::render_overview_svg(input));
}

/// "SCENARIO-SEED", with "-short" for the short form.
std::string run_name(const ExperimentOptions& options) {
  return options.scenario + "-" + std::to_string(options.seed) + (options.short_form ? "-short" : "");
}

void run_experiment(ExperimentOptions options, const std::string& command) {
  if (options.scenario.empty())
    throw UsageError("SCENARIO: missing; `isobar experiment --help` shows the names");
  if (options.out.empty()) options.out = "out/" + run_name(options);
  const std::vector<Method> methods = chosen_methods(options);
  std::filesystem::create_directories(options.out);
  const std::filesystem::path recording = options.out / ("recording-" + run_name(options));
  simulate_if_missing(options, recording);
  replay_all(options, recording, methods);
  evaluate_all(options, recording, methods, command);
}

}  // namespace

void add_experiment_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<ExperimentOptions>(
      app, "experiment", "One of the paper's experiments: simulate, replay with all methods, evaluate",
      run_experiment);
  add_sensitivity_command(command);
  command.add_option("SCENARIO", options.scenario,
                     "three-floors, elevator, moulin; `isobar simulate --list` shows all");
  command.add_option("--seed", options.seed, "random seed of world and sensor errors")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--short", options.short_form, "the short form of the scenario");
  command.add_option("--out", options.out,
                     "folder for recording, runs and report (default: out/SCENARIO-SEED)");
  command.add_option("--config", options.config, "TOML file with the estimator's settings");
  command.add_option("--methods", options.methods, method_names() + " (default: all)")->delimiter(',');
  command.add_option("--jobs", options.jobs, "replays at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
}

}  // namespace isobar::tools
