// SPDX-License-Identifier: BSD-3-Clause
// `isobar simulate`: makes a recording from a scenario and a seed.
#include "simulation/simulate.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "core/errors.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/scenario_list.hpp"
#include "tools/commands.hpp"
#include "tools/deviation_options.hpp"
#include "tools/lidar_option.hpp"
#include "tools/number_option.hpp"
#include "tools/progress.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct SimulateOptions {
  simulation::ScenarioRequest request;
  std::string out_dir;
  bool list = false;
};

void run_simulate(const SimulateOptions& options) {
  if (options.list) {
    for (const simulation::ScenarioInfo& info : simulation::scenarios()) {
      std::printf("%-14s %s\n", info.name.c_str(), info.description.c_str());
    }
    return;
  }
  if (options.request.name.empty()) throw UsageError("SCENARIO: missing; `isobar simulate --list` shows all");
  (void)simulation::find_scenario(options.request.name);
  (void)simulation::find_lidar_plan(options.request.lidar);
  if (options.out_dir.empty()) throw UsageError("--out: missing; it names the folder for the recording");
  Progress progress("simulate " + options.request.name);
  simulation::simulate(options.request, options.out_dir, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  std::printf("%s\n", options.out_dir.c_str());
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  const auto [command, options] =
      add_subcommand<SimulateOptions>(app, "simulate", "Make a recording of a simulated robot", run_simulate);
  command.add_option("SCENARIO", options.request.name, "name of a scenario; --list shows all");
  command.add_option("--seed", options.request.seed, "random seed of world, path and sensor errors")
      ->capture_default_str()
      ->check(number_from_zero());
  command.add_option(
      "--session-seed", options.request.session_seed,
      "another session on the same site: other errors, weather and furniture; 0: the first one");
  command.add_option("--out", options.out_dir, "folder for the recording, created if missing");
  command.add_flag("--short", options.request.short_form, "30 to 60 s instead of the whole run");
  add_lidar_option(command, options.request);
  command.add_option("--stop-after", options.request.stop_after_s, "end the run after this time [s]")
      ->check(number_above_zero());
  add_deviation_options(command, options.request.deviations);
  command.add_flag("--list", options.list, "list the scenarios and exit");
}

}  // namespace isobar::tools
