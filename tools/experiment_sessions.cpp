// SPDX-License-Identifier: BSD-3-Clause
// `isobar experiment second-session`: sessions of other errors, weather and furniture in the map of a first one.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "core/stamp.hpp"
#include "daemon/replay.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/evaluation/second_session.hpp"
#include "simulation/scenario_list.hpp"
#include "simulation/simulate.hpp"
#include "tools/commands.hpp"
#include "tools/deviation_options.hpp"
#include "tools/experiment_recording.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

namespace fs = std::filesystem;

struct SessionOptions {
  simulation::ScenarioRequest request{.name = "three-floors"};
  std::vector<std::uint64_t> sessions{7, 8};
  std::vector<double> starts_s{0.0, 14.0, 30.0};
  std::vector<std::string> uses{"localise", "extend"};
  fs::path out;
  fs::path config;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

/// A row of the table.
struct SessionResult {
  simulation::ScenarioRequest request;
  MapUse use = MapUse::kLocalise;
  double without_pose_s = 0.0;
  evaluation::SecondSessionError error;
  std::string failure;
};

fs::path recording_of(const SessionOptions& options, const simulation::ScenarioRequest& request) {
  return options.out / ("recording-" + simulation::recording_name(request));
}

fs::path run_of(const SessionOptions& options, const SessionResult& session) {
  return options.out /
         (simulation::recording_name(session.request) + "-" + std::string(kMapUseNames.name(session.use)));
}

fs::path first_run_of(const SessionOptions& options) {
  return options.out / simulation::recording_name(options.request);
}

/// Each session at each start and with each use of the map.
std::vector<SessionResult> sessions_of(const SessionOptions& options) {
  std::vector<SessionResult> sessions;
  for (const std::uint64_t seed : options.sessions) {
    if (seed == 0) throw UsageError("--sessions: 0 is the first session");
    for (const double start_s : options.starts_s) {
      for (const std::string& name : options.uses) {
        SessionResult& one = sessions.emplace_back();
        const auto use = kMapUseNames.value(name);
        if (!use || *use == MapUse::kNew) {
          throw UsageError("--map-use: \"" + name + "\" is none of extend, localise");
        }
        one.use = *use;
        one.request = options.request;
        one.request.session_seed = seed;
        one.request.deviations.start_at_s = start_s;
      }
    }
  }
  return sessions;
}

/// A run of an earlier call is replaced.
void replay_into(const fs::path& recording, const Config& config, const fs::path& run) {
  fs::remove_all(run);
  const ReplaySummary summary = replay(recording, config, run, [](double) {});
  std::printf("%-44s %6.1f s of recording in %5.1f s\n", run.filename().c_str(), summary.recorded_s,
              summary.wall_s);
}

/// @throws DataError if the run has no pose
void run_session(const SessionOptions& options, Config config, SessionResult& session) {
  const fs::path run = run_of(options, session);
  config.map_files.stored = first_run_of(options);
  config.map_files.use = session.use;
  replay_into(recording_of(options, session.request), config, run);
  const evaluation::Trajectory first_truth =
      evaluation::load_reference(recording_of(options, options.request)).trajectory;
  const evaluation::Trajectory truth =
      evaluation::load_reference(recording_of(options, session.request)).trajectory;
  const evaluation::Trajectory poses = evaluation::read_estimate(run);
  if (poses.empty() || truth.empty()) throw DataError("the place was never found");
  session.without_pose_s = seconds_between(truth.poses.front().stamp_ns, poses.poses.front().stamp_ns);
  const evaluation::Trajectory first_poses = evaluation::read_estimate(first_run_of(options));
  session.error = evaluation::second_session_error({first_truth, first_poses}, {truth, poses});
}

/// Runs all sessions, `jobs` at a time. Recordings are there.
void run_sessions(const SessionOptions& options, const Config& config, std::vector<SessionResult>& sessions) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < sessions.size(); i = next++) {
      try {
        run_session(options, config, sessions[i]);
      } catch (const std::exception& error) {
        sessions[i].failure = error.what();
      }
    }
  };
  std::vector<std::jthread> workers;
  for (std::size_t i = 1; i < std::min(options.jobs, sessions.size()); ++i) workers.emplace_back(work);
  work();
  workers.clear();
}

std::string table_of(const SessionOptions& options, const std::vector<SessionResult>& sessions) {
  std::string table = "In the frame of " + first_run_of(options).filename().string() +
                      "\nsession  start  map use   without a pose  position rms     max   yaw rms     max\n";
  for (const SessionResult& one : sessions) {
    char line[160];  // NOLINT(modernize-avoid-c-arrays): for snprintf
    const evaluation::SecondSessionError& error = one.error;
    std::snprintf(line, sizeof line, "%7llu  %3.0f s  %-8s  ",
                  static_cast<unsigned long long>(one.request.session_seed),
                  one.request.deviations.start_at_s, std::string(kMapUseNames.name(one.use)).c_str());
    table += line;
    if (!one.failure.empty()) {
      table += "FAILED: " + one.failure + "\n";
      continue;
    }
    std::snprintf(line, sizeof line, "%12.1f s       %.3f m  %.3f m  %.2f deg  %.2f deg\n",
                  one.without_pose_s, error.position_rms_m, error.position_max_m,
                  error.yaw_rms_rad / kRadPerDeg, error.yaw_max_rad / kRadPerDeg);
    table += line;
  }
  return table;
}

void run_experiment_sessions(SessionOptions options) {
  if (options.out.empty()) options.out = "out/sessions-" + simulation::recording_name(options.request);
  std::vector<SessionResult> sessions = sessions_of(options);
  const Config config = options.config.empty() ? Config{} : load_config(options.config);
  (void)simulation::find_scenario(options.request.name);  // before a folder is made
  fs::create_directories(options.out);
  const fs::path first = recording_of(options, options.request);
  simulate_if_missing(options.request, first, {});
  replay_into(first, config, first_run_of(options));
  for (const SessionResult& one : sessions) {
    simulate_if_missing(one.request, recording_of(options, one.request), {});
  }
  run_sessions(options, config, sessions);
  const std::string table = table_of(options, sessions);
  std::printf("\n%s\n", table.c_str());
  write_output(options.out / "second-session.txt", table);
  const auto failed = std::count_if(sessions.begin(), sessions.end(),
                                    [](const SessionResult& one) { return !one.failure.empty(); });
  if (failed > 0) throw DataError(std::to_string(failed) + " sessions failed: see above");
}

}  // namespace

void add_experiment_sessions_command(CLI::App& experiment) {
  const auto [command, options] = add_subcommand<SessionOptions>(
      experiment, "second-session", "Other sessions in the map of a first one: errors in its frame",
      run_experiment_sessions);
  command.add_option("SCENARIO", options.request.name, "`isobar simulate --list` shows all")
      ->capture_default_str();
  command.add_option("--seed", options.request.seed, "random seed of the world, and of the first session")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--short", options.request.short_form, "the short form of the scenario");
  command
      .add_option("--sessions", options.sessions,
                  "random seeds of the sessions' errors, weather and furniture")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--starts", options.starts_s, "where they begin: times of the run [s]")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--map-use", options.uses, "localise, extend")->delimiter(',')->capture_default_str();
  command.add_option(
      "--out", options.out,
      "folder for second-session.txt, recordings and runs (default: out/sessions-SCENARIO-SEED)");
  command.add_option("--config", options.config, "TOML file with the estimator's settings");
  command.add_option("--jobs", options.jobs, "replays at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  add_deviation_options(command, options.request.deviations);
}

}  // namespace isobar::tools
