// SPDX-License-Identifier: BSD-3-Clause
// `isobar simulate`: a scenario and a seed become a recording folder.
#include "simulation/simulate.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "core/errors.hpp"
#include "tools/commands.hpp"
#include "tools/progress.hpp"

namespace isobar::tools {

namespace {

struct SimulateOptions {
  simulation::ScenarioRequest request;
  std::string out_dir;
  bool list = false;
};

void run(const SimulateOptions& options) {
  if (options.list) {
    for (const simulation::ScenarioInfo& info : simulation::scenarios()) {
      std::printf("%-14s %s\n", info.name.c_str(), info.description.c_str());
    }
    return;
  }
  if (options.request.name.empty()) throw UsageError("which scenario? `isobar simulate --list` names them");
  if (!(options.request.stop_after_s > 0.0)) throw UsageError("--stop-after: must be more than 0 s");
  if (options.out_dir.empty()) throw UsageError("--out: the folder for the recording is missing");
  Progress progress("simulate " + options.request.name);
  simulation::simulate(options.request, options.out_dir, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  std::printf("%s\n", options.out_dir.c_str());
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand("simulate", "Make a recording of a simulated robot");
  command->add_option("SCENARIO", options->request.name, "one of those that --list names");
  command->add_option("--seed", options->request.seed, "draws the world, the path and the sensors' errors")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--out", options->out_dir, "folder for the recording, made if missing");
  command->add_flag("--short", options->request.short_form, "30 to 60 s instead of the whole run");
  command->add_option("--stop-after", options->request.stop_after_s, "cut the run short [s]");
  command->add_flag("--list", options->list, "name the scenarios and end");
  command->callback([options] { run(*options); });
}

}  // namespace isobar::tools
