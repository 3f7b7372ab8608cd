// SPDX-License-Identifier: BSD-3-Clause
// `isobar experiment`: one of the paper's experiments from nothing: simulate, run all methods, table, report.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/names.hpp"
#include "daemon/replay.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/files/text_file.hpp"
#include "run/recording/manifest.hpp"
#include "simulation/simulate.hpp"
#include "tools/commands.hpp"
#include "tools/method_option.hpp"
#include "tools/progress.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/report/report.hpp"
#include "tools/report/terminal_table.hpp"

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
    const auto method = method_of(name);
    if (!method) throw UsageError("--methods: \"" + name + "\" is none of " + method_names());
    methods.push_back(*method);
  }
  return methods;
}

void simulate_if_missing(const ExperimentOptions& options, const std::filesystem::path& recording) {
  if (std::filesystem::exists(recording / recording::kManifestFile)) {
    std::printf("recording %s is there already\n", recording.c_str());
    return;
  }
  // A name of its own until it is whole: an interrupted simulation is never taken for a recording.
  const std::filesystem::path unfinished = recording.string() + ".unfinished";
  std::filesystem::remove_all(unfinished);
  Progress progress("simulating");
  simulation::simulate({options.scenario, options.seed, options.short_form}, unfinished,
                       [&](double fraction) { progress.update(fraction); });
  progress.finish();
  std::filesystem::rename(unfinished, recording);
}

/// Replays with every method, `jobs` at a time. The first error ends it.
void replay_all(const ExperimentOptions& options, const std::filesystem::path& recording,
                const std::vector<Method>& methods) {
  const Config config = options.config.empty() ? Config{} : load_config(options.config);
  Progress progress("replaying " + std::to_string(methods.size()) + " methods");
  std::mutex mutex;
  std::vector<double> fractions(methods.size(), 0.0);
  std::exception_ptr first_error;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < methods.size(); i = next++) {
      Config own = config;
      own.method = methods[i];
      try {
        const auto report_progress = [&](double fraction) {
          const std::lock_guard lock(mutex);
          fractions[i] = fraction;
          double sum = 0.0;
          for (const double f : fractions) sum += f;
          progress.update(sum / static_cast<double>(methods.size()));
        };
        const ReplaySummary summary =
            replay(recording, own, options.out / std::string(method_name(methods[i])), report_progress);
        const std::lock_guard lock(mutex);
        std::printf("%-14s %6.1f s of recording in %5.1f s (%zu at a time)\n",
                    std::string(method_name(methods[i])).c_str(), summary.recorded_s, summary.wall_s,
                    std::min(options.jobs, methods.size()));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!first_error) first_error = std::current_exception();
        next = methods.size();
      }
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t i = 1; i < std::min(options.jobs, methods.size()); ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  progress.finish();
  if (first_error) std::rethrow_exception(first_error);
}

std::string title_of(const std::string& scenario) {
  if (scenario == "three-floors") return "Three floors";
  if (scenario == "elevator") return "Elevator";
  if (scenario == "moulin") return "Moulin";
  return scenario;
}

void evaluate_all(const ExperimentOptions& options, const std::filesystem::path& recording,
                  const std::vector<Method>& methods) {
  std::vector<evaluation::EstimateSource> sources;
  for (const Method method : methods) {
    const std::string name(method_name(method));
    sources.push_back({name, options.out / name});
  }
  report::ReportInput input;
  input.run = evaluation::evaluate_methods(evaluation::load_reference(recording), sources);
  input.title = title_of(options.scenario) + ", seed " + std::to_string(options.seed);
  input.description = "Simulated recording \"" + options.scenario + "\"" +
                      (options.short_form ? " in its short form" : "") +
                      ", replayed with each method on the same sensor data.";
  input.command = "isobar experiment " + options.scenario + " --seed " + std::to_string(options.seed) +
                  (options.short_form ? " --short" : "") + " --out " + options.out.string();
  report::print_table(stdout, input.run);
  report::write_report(options.out / "report.html", input);
  files::write_text_file(options.out / "figures.json", report::figures_json(input.run));
  files::write_text_file(options.out / "overview.svg", report::render_overview_svg(input));
  std::printf("written: %s/report.html figures.json overview.svg\n", options.out.c_str());
}

void run(const ExperimentOptions& options) {
  const std::vector<Method> methods = chosen_methods(options);
  std::filesystem::create_directories(options.out);
  const std::filesystem::path recording =
      options.out / ("recording-" + options.scenario + "-" + std::to_string(options.seed) +
                     (options.short_form ? "-short" : ""));
  simulate_if_missing(options, recording);
  replay_all(options, recording, methods);
  evaluate_all(options, recording, methods);
}

}  // namespace

void add_experiment_command(CLI::App& app) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "experiment", "One of the paper's experiments: simulate, run all methods, table, report");
  add_sensitivity_command(*command);
  command->add_option("SCENARIO", options->scenario,
                      "three-floors, elevator, moulin; `isobar simulate --list` names all");
  command->add_option("--seed", options->seed, "draws the world and the errors of all sensors")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--short", options->short_form, "the short form of the scenario");
  command->add_option("--out", options->out,
                      "folder for recording, runs and report (default: out/SCENARIO-SEED)");
  command->add_option("--config", options->config, "TOML file for the algorithm's settings");
  command->add_option("--methods", options->methods, method_names() + " (default: all)")->delimiter(',');
  command->add_option("--jobs", options->jobs, "methods replayed at the same time")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  command->callback([options, command] {
    if (!command->get_subcommands().empty()) return;
    if (options->scenario.empty()) throw UsageError("which scenario? `isobar experiment --help` names them");
    if (options->out.empty()) {
      options->out = "out/" + options->scenario + "-" + std::to_string(options->seed) +
                     (options->short_form ? "-short" : "");
    }
    run(*options);
  });
}

}  // namespace isobar::tools
