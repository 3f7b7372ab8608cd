// SPDX-License-Identifier: BSD-3-Clause
// Two sessions of one robot: the second one begins somewhere in the map of the first.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/evaluation/second_session.hpp"
#include "run/files/run_layout.hpp"
#include "simulation/simulate.hpp"
#include "tests/integration/replay/recordings.hpp"
#include "tests/support/message_of.hpp"

namespace isobar::test::test_stored_map {
namespace {

namespace fs = std::filesystem;

fs::path simulate_session(std::uint64_t seed, std::uint64_t session, double start_at_s, double stop_after_s) {
  simulation::ScenarioRequest request;
  request.name = "three-floors";
  request.seed = seed;
  request.session_seed = session;
  request.short_form = true;
  request.deviations.start_at_s = start_at_s;
  request.stop_after_s = stop_after_s;
  fs::path folder = fresh_folder("session");
  simulation::simulate(request, folder, {});
  return folder;
}

ReplaySummary replay_in(const fs::path& recording, const Config& config, fs::path& out) {
  out = fresh_folder("run");
  return replay(recording, config, out, [](double) {});
}

/// Recording and run of the first session, along the corridor of the ground floor, and the recording of the second one.
struct Sessions {
  fs::path first = simulate_session(1, 0, 0.0, 20.0);
  fs::path run;
  fs::path second = simulate_session(1, 7, 9.0, 16.0);
  Sessions() { replay_in(first, Config{}, run); }
};

const Sessions& sessions() {
  static const Sessions kSessions;
  return kSessions;
}

Config in_map(const fs::path& map, MapUse use) {
  Config config;
  config.map_files.stored = map.string();
  config.map_files.use = use;
  return config;
}

/// Names and bytes of all files of a folder.
std::map<std::string, std::string> content_of(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      content[fs::relative(entry.path(), folder).string()] = bytes_of(entry.path());
    }
  }
  return content;
}

evaluation::SecondSessionError error_of(const fs::path& out) {
  const auto trajectory_of = [](const fs::path& file) { return evaluation::load_reference(file).trajectory; };
  const auto truth_before = trajectory_of(sessions().first);
  const auto before = trajectory_of(sessions().run / files::kTrajectoryFile);
  const auto truth = trajectory_of(sessions().second);
  const auto poses = trajectory_of(out / files::kTrajectoryFile);
  return evaluation::second_session_error({truth_before, before}, {truth, poses});
}

}  // namespace

TEST_CASE("a second session is in the frame of the first, whose map stays as it is") {
  const auto before = content_of(sessions().run);
  for (const MapUse use : {MapUse::kLocalise, MapUse::kExtend}) {
    CAPTURE(kMapUseNames.name(use));
    fs::path out;
    const ReplaySummary summary = replay_in(sessions().second, in_map(sessions().run, use), out);
    const evaluation::SecondSessionError error = error_of(out);
    MESSAGE("rms " << error.position_rms_m << " m, " << error.yaw_rms_rad / kRadPerDeg << " deg");
    CHECK(error.poses > 50);  // 7 s at 10 Hz, less 2 s for gravity, height and the search
    CHECK(error.position_max_m < 0.05);
    CHECK(error.yaw_rms_rad < 0.3 * kRadPerDeg);
    CHECK(summary.from_prior == 0);
    CHECK(fs::exists(out / "map") == (use == MapUse::kExtend));
    CHECK(content_of(sessions().run) == before);
  }
}

TEST_CASE("the folder of the tiles alone suffices, and two runs in it are bit-identical") {
  const fs::path moved = fresh_folder("moved");
  fs::create_directories(moved);
  fs::copy(sessions().run / "map", moved / "tiles");
  fs::path once;
  fs::path twice;
  replay_in(sessions().second, in_map(moved / "tiles", MapUse::kLocalise), once);
  replay_in(sessions().second, in_map(moved / "tiles", MapUse::kLocalise), twice);
  CHECK(error_of(once).position_max_m < 0.05);
  CHECK(bytes_of(once / files::kTrajectoryFile) == bytes_of(twice / files::kTrajectoryFile));
}

TEST_CASE("a robot in another building finds no place in the map, says so, and begins a map of its own") {
  const fs::path elsewhere = simulate_session(4, 0, 0.0, 14.0);
  const auto before = content_of(sessions().run);
  fs::path out;
  const ReplaySummary lost = replay_in(elsewhere, in_map(sessions().run, MapUse::kLocalise), out);
  CHECK(lost.registered == 0);
  CHECK(std::any_of(lost.warnings.begin(), lost.warnings.end(),
                    [](const auto& text) { return text.find("no place of the map fits") == 0; }));
  const ReplaySummary begun = replay_in(elsewhere, in_map(sessions().run, MapUse::kExtend), out);
  CHECK(begun.registered > 50);
  CHECK(fs::exists(out / "trajectory_2.tum"));
  CHECK(fs::exists(out / "map_2" / "map.toml"));
  CHECK(content_of(sessions().run) == before);
}

TEST_CASE("a map that cannot be used is refused in words, and nothing of it is changed") {
  const auto refusal = [](const fs::path& map, Config config = {}) {
    config.map_files.stored = map.string();
    fs::path out;
    return message_of([&] { replay_in(sessions().second, config, out); });
  };
  const fs::path broken = fresh_folder("broken");
  fs::copy(sessions().run / "map", broken);
  CHECK(refusal(fresh_folder("nowhere")).find("holds no map") != std::string::npos);
  Config coarse;
  coarse.map.cell_m = 0.5;
  CHECK(refusal(broken, coarse).find("the configuration requires") != std::string::npos);
  std::ofstream(broken / "map.toml") << "format = 99\ntile_m = 8.0\ncell_m = 0.25\n";
  CHECK(refusal(broken).find("this program supports no other format of map") != std::string::npos);
  fs::copy_file(sessions().run / "map" / "map.toml", broken / "map.toml",
                fs::copy_options::overwrite_existing);
  fs::resize_file(broken / "checkpoint", 100);
  CHECK(refusal(broken).find("checkpoint") != std::string::npos);
  Config localise;
  localise.map_files.use = MapUse::kLocalise;
  CHECK(refusal("", localise).find("localise needs the folder of a stored map") != std::string::npos);
}

}  // namespace isobar::test::test_stored_map
