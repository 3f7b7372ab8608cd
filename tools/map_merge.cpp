// SPDX-License-Identifier: BSD-3-Clause
// `isobar map merge`: two maps that share a part become one.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "daemon/base_station_names.hpp"
#include "daemon/stage_settings.hpp"
#include "run/files/checkpoint.hpp"
#include "run/files/run_layout.hpp"
#include "run/floors/floor_names.hpp"
#include "run/floors/stored_floors.hpp"
#include "run/merge/height_relation.hpp"
#include "run/merge/merge_maps.hpp"
#include "tools/map_parts.hpp"
#include "tools/output_option.hpp"
#include "tools/progress.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct MergeOptions {
  std::filesystem::path a;
  std::filesystem::path b;
  std::filesystem::path out;
};

/// Settings of the run that made a map; the defaults where they are missing.
StageSettings settings_of(const std::filesystem::path& map_folder) {
  const std::filesystem::path file = files::run_folder_of(map_folder) / files::kSettingsFile;
  std::error_code error;
  return stage_settings(std::filesystem::exists(file, error) ? load_config(file) : Config{});
}

/// What the air says of both heights; a note where it says nothing.
HeightRelation relation_of(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto of_a = files::checkpoint_of_map(a);
  auto of_b = files::checkpoint_of_map(b);
  if (of_a && of_b && !take_over_stations(*of_b, of_a->stations).empty()) {
    std::printf("note: the heights of A and B refer to base stations of different names\n");
  }
  const auto relation =
      of_a && of_b ? files::height_relation(of_a->datum, of_b->datum) : std::optional<HeightRelation>();
  if (!relation) {
    std::printf(
        "note: no base station ties the heights of both (no checkpoint beside a map): floors that look "
        "alike cannot be told apart\n");
  }
  return relation.value_or(HeightRelation{});
}

files::MergeRequest request_of(const MergeOptions& options) {
  files::MergeRequest request;
  request.a.map_folder = map_folder_of(options.a);
  request.b.map_folder = map_folder_of(options.b);
  request.out = options.out;
  const StageSettings a = settings_of(request.a.map_folder);
  request.a.T_base_lidar = a.T_base_lidar;
  request.b.T_base_lidar = settings_of(request.b.map_folder).T_base_lidar;
  request.height = relation_of(request.a.map_folder, request.b.map_folder);
  request.settings = {a.loops, a.map, a.registration};
  return request;
}

void print_search(const files::MergeReport& report) {
  const FrameVerdict& frame = report.figures.frame;
  std::printf("places of B: %zu searched in A, %zu found, %zu agree\n", report.figures.searched,
              frame.located, frame.agreeing.size());
  if (report.figures.tried == 0) return;
  std::printf("loops between A and B: %zu tried, %zu matched, %zu taken\n", report.figures.tried,
              report.figures.matched, report.figures.loops);
}

void print_result(const files::MergeReport& report) {
  const Eigen::Isometry3d& T_a_b = report.figures.T_a_b;
  std::printf("origin of B in A: x %.3f, y %.3f, z %.3f m, yaw %.2f deg; rms at the loops %.3f m\n",
              T_a_b.translation().x(), T_a_b.translation().y(), T_a_b.translation().z(),
              yaw_of(T_a_b.linear()) / kRadPerDeg, report.figures.rms_m);
  std::printf("submaps: %zu of A, %zu of B; %zu key scans in %zu tiles\n", report.submaps_a, report.submaps_b,
              report.keys, report.tiles);
  std::printf("cells of A that B has seen through, and which are gone: %llu\n",
              static_cast<unsigned long long>(report.gone));
  if (report.missing_keys > 0) {
    std::printf("key scans that cannot be read, and are left out: %zu\n", report.missing_keys);
  }
  if (report.b_later_ns > 0) {
    std::printf("stamps of B are moved by %lld ns in the result, behind those of A\n",
                static_cast<long long>(report.b_later_ns));
  }
}

void print_floors(const std::filesystem::path& out) {
  const std::filesystem::path map = map_folder_of(out);
  const auto store = open_map(out);
  const files::FloorNames names = files::FloorNames::read(map);
  const files::StoredFloors found =
      files::find_stored_floors(*store, files::path_of(files::trajectory_of_map(map)));
  for (const Floor& floor : found.floors.floors) {
    const std::string name = names.name_of(floor);
    std::printf("floor %d%s%s at %.2f m, %.0f m2\n", floor.number, name.empty() ? "" : ", ", name.c_str(),
                floor.height_m, floor.area_m2);
  }
}

void run_merge(const MergeOptions& options) {
  for (const auto& side : {options.a, options.b}) require_path(side, "the folder of a map, or of a run");
  const files::MergeRequest request = request_of(options);
  Progress progress("merging");
  const files::MergeReport report =
      files::merge_maps(request, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  for (const std::string& note : report.notes) std::printf("note: %s\n", note.c_str());
  print_search(report);
  if (!report.problem.empty()) {
    throw DataError(options.b.string() + ": does not fit into " + options.a.string() + ": " + report.problem +
                    "; nothing was written");
  }
  print_result(report);
  print_floors(options.out);
  std::printf("written: %s\n", options.out.c_str());
}

}  // namespace

void add_map_merge_command(CLI::App& map) {
  const auto [command, options] = add_subcommand<MergeOptions>(
      map, "merge", "Join two maps of one building, of one base station, into a third one", run_merge);
  command
      .add_option("A", options.a,
                  "folder of a map, or of a run: the result has its frame, and what it says of "
                  "a place holds until B has seen otherwise")
      ->required();
  command.add_option("B", options.b, "the later one, which shares a part of the way with A")->required();
  command.add_option("--out", options.out, "new folder for the result: map/, trajectory.tum, settings.toml")
      ->required();
}

}  // namespace isobar::tools
