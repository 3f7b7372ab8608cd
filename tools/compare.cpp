// SPDX-License-Identifier: BSD-3-Clause
// `isobar compare`: two runs, or two configurations replayed on the same recordings, side by side.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "config/settings_by_key.hpp"
#include "core/errors.hpp"
#include "daemon/replay.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/files/run_layout.hpp"
#include "simulation/scenario_list.hpp"
#include "simulation/simulate.hpp"
#include "tools/commands.hpp"
#include "tools/comparison.hpp"
#include "tools/experiment_recording.hpp"
#include "tools/output_option.hpp"
#include "tools/progress.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/provenance.hpp"
#include "tools/report/report.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kSides{"A", "B"};

struct CompareOptions {
  std::array<fs::path, 2> sides;
  std::vector<fs::path> recordings;  ///< or, for two runs, one reference
  std::string scenario;
  std::vector<std::uint64_t> seeds{1, 2, 3, 4, 5};
  bool short_form = false;
  fs::path out = "out/compare";
  fs::path json;
  fs::path report;
};

bool is_config(const fs::path& path) { return path.extension() == ".toml"; }

/// The recordings to replay; simulated ones are made where they are missing.
std::vector<fs::path> recordings_of(const CompareOptions& options) {
  std::vector<fs::path> recordings = options.recordings;
  if (options.scenario.empty()) return recordings;
  for (const std::uint64_t seed : options.seeds) {
    simulation::ScenarioRequest request;
    request.name = options.scenario;
    request.seed = seed;
    request.short_form = options.short_form;
    recordings.push_back(options.out / ("recording-" + simulation::recording_name(request)));
    Progress progress("simulating " + simulation::recording_name(request));
    simulate_if_missing(request, recordings.back(), [&](double part) { progress.update(part); });
    progress.finish();
  }
  return recordings;
}

/// Replays both sides of one recording.
std::array<fs::path, 2> replay_sides(const CompareOptions& options, const std::array<Config, 2>& configs,
                                     const fs::path& recording) {
  std::array<fs::path, 2> runs;
  for (std::size_t side = 0; side < 2; ++side) {
    runs[side] = options.out / recording.filename() / kSides[side];
    files::remove_run(runs[side]);
    Progress progress("replaying " + recording.filename().string() + ", " + kSides[side]);
    (void)replay(recording, configs[side], runs[side], [&](double part) { progress.update(part); });
    progress.finish();
  }
  return runs;
}

evaluation::EvaluatedRun evaluate_sides(const fs::path& reference, const std::array<fs::path, 2>& runs) {
  return evaluation::evaluate_methods(evaluation::load_reference(reference),
                                      {{"A", runs[0]}, {"B", runs[1]}});
}

void print_settings(const std::array<Config, 2>& configs) {
  const auto first = settings_by_key(configs[0]);
  const auto second = settings_by_key(configs[1]);
  std::vector<report::Cells> rows{{"setting", "A", "B"}};
  for (const auto& [key, value] : first) {
    const auto other = second.find(key);
    if (other != second.end() && other->second != value) rows.push_back({key, value, other->second});
  }
  if (rows.size() == 1) {
    std::printf("A and B have the same settings\n\n");
    return;
  }
  std::printf("%s\n", report::aligned_rows(rows).c_str());
}

void print_settings(const evaluation::EvaluatedRun& run) {
  std::vector<report::Cells> rows{{"setting", "A", "B"}};
  for (const report::DifferingSetting& setting : report::differing_settings(run))
    rows.push_back({setting.key, setting.values[0], setting.values[1]});
  if (rows.size() > 1) {
    std::printf("%s\n", report::aligned_rows(rows).c_str());
  } else {
    std::printf("No setting is known that differs between the runs (settings.toml of each)\n\n");
  }
}

void print_verdicts(const evaluation::EvaluatedRun& run, const std::string& recording) {
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    const evaluation::Verdict& verdict = method.evaluation.figures.verdict;
    if (!verdict.ok())
      std::printf("note: %s, %s: %s, %s\n", recording.c_str(), method.name.c_str(),
                  verdict_word(verdict.kind), verdict.reason.c_str());
  }
}

/// @throws UsageError, or DataError where nothing is there
void check(const CompareOptions& options) {
  const bool configs = is_config(options.sides[0]);
  for (const fs::path& side : options.sides) {
    require_path(side, "the folder of a run, or a configuration (.toml)");
    if (fs::is_directory(side) && !files::holds_run(side))
      throw DataError(side.string() + ": is no run; a run is a folder with trajectory.tum");
  }
  if (configs != is_config(options.sides[1]))
    throw UsageError("A and B: must be two runs or two configurations (.toml)");
  if (configs && options.recordings.empty() && options.scenario.empty())
    throw UsageError(
        "--recordings: missing; recordings with a reference, or --scenario NAME to simulate some");
  if (!configs && (options.recordings.size() != 1 || !options.scenario.empty()))
    throw UsageError(
        "--recordings: two runs are compared with one reference, the recording of both or a .tum file");
  for (const fs::path& recording : options.recordings)
    require_path(recording, "a recording with a reference, or a .tum file");
  if (!options.scenario.empty()) (void)simulation::find_scenario(options.scenario);
}

void write_files(const CompareOptions& options, const std::vector<ComparedFigure>& figures,
                 const std::vector<ComparedRecording>& recordings, evaluation::EvaluatedRun last,
                 const std::string& command) {
  if (!options.json.empty()) write_output(options.json, comparison_json(figures, recordings, command));
  if (options.report.empty()) return;
  report::ReportInput input;
  input.run = std::move(last);
  input.title = "A and B on " + recordings.back().name;
  input.description = "A: " + options.sides[0].string() + ". B: " + options.sides[1].string() + ".";
  input.command = command;
  write_output(options.report, report::render_report(input));
}

void run_compare(const CompareOptions& options, const std::string& command) {
  check(options);
  const bool configs = is_config(options.sides[0]);
  std::array<Config, 2> loaded;
  if (configs) loaded = {load_config(options.sides[0]), load_config(options.sides[1])};
  std::printf("A: %s\nB: %s\n\n", options.sides[0].c_str(), options.sides[1].c_str());
  if (configs) print_settings(loaded);
  std::vector<ComparedRecording> recordings;
  evaluation::EvaluatedRun last;
  for (const fs::path& recording : recordings_of(options)) {
    const auto runs = configs ? replay_sides(options, loaded, recording) : options.sides;
    last = evaluate_sides(recording, runs);
    recordings.push_back({recording.filename().string(), last.methods[0].evaluation.figures,
                          last.methods[1].evaluation.figures});
    print_verdicts(last, recordings.back().name);
  }
  if (!configs) print_settings(last);
  const std::vector<ComparedFigure> figures = compare_figures(recordings);
  const bool is_single = recordings.size() == 1;
  std::printf("%s\n%s\n%s\n",
              is_single
                  ? "1 recording"
                  : (std::to_string(recordings.size()) +
                     " recordings. A and B: medians over them; B - A: mean of the differences, with its 95 % "
                     "interval; better or worse: beyond it")
                        .c_str(),
              comparison_table(figures).c_str(), comparison_summary(figures).c_str());
  write_files(options, figures, recordings, std::move(last), command);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<CompareOptions>(
      app, "compare", "Two runs or two configurations side by side: what differs, what is better",
      run_compare);
  command.add_option("A", options.sides[0], "folder of a run, or a configuration (.toml)")->required();
  command.add_option("B", options.sides[1], "the same, to be judged against A")->required();
  command
      .add_option("--recordings", options.recordings,
                  "recordings with a reference, on which both are replayed; of two runs: their reference")
      ->option_text("FOLDER…");
  command.add_option("--scenario", options.scenario, "simulate recordings of this scenario");
  command.add_option("--seeds", options.seeds, "seeds of --scenario, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  command.add_flag("--short", options.short_form, "the short form of --scenario");
  command.add_option("--out", options.out, "folder for recordings and runs that are made")
      ->capture_default_str();
  command.add_option("--json", options.json, "JSON file for all figures")->check(written_as({".json"}));
  command.add_option("--report", options.report, "HTML file for a report of the last recording")
      ->check(written_as({".html", ".htm"}));
}

}  // namespace isobar::tools
