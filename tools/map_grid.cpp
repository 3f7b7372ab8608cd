// SPDX-License-Identifier: BSD-3-Clause
// `isobar map grid`: occupancy grids of floors, for map_server.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/floors/floor_names.hpp"
#include "run/floors/grid_file.hpp"
#include "run/floors/stored_floors.hpp"
#include "tools/map_parts.hpp"
#include "tools/number_option.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct GridOptions {
  std::filesystem::path directory;
  std::filesystem::path out;
  std::string floor = "all";
  GridConfig grid;
};

std::string title_of(const Floor& floor, const std::string& name) {
  char text[160];
  std::snprintf(text, sizeof(text), "isobar: floor %d at %.2f m%s%s", floor.number, floor.height_m,
                name.empty() ? "" : ", ", name.c_str());
  return text;
}

void run_grid(const GridOptions& options) {
  const std::filesystem::path map = map_folder_of(options.directory);
  const auto store = open_map(options.directory);
  const files::FloorNames names = files::FloorNames::read(map);
  const std::vector<Eigen::Vector3d> path = files::path_of(files::trajectory_of_map(map));
  const files::StoredFloors found = files::find_stored_floors(*store, path);
  std::vector<Floor> wanted = found.floors.floors;
  if (options.floor != "all") wanted = {files::floor_by(found.floors, names, options.floor)};
  if (wanted.empty()) throw DataError(options.directory.string() + ": the map holds no floor");
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) throw ServiceError(options.out.string() + ": cannot be created: " + error.message());
  print_faults(store->counters());
  for (const Floor& floor : wanted) {
    const OccupancyGrid grid = files::stored_floor_grid(*store, found, floor, path, options.grid);
    const std::string name = "floor_" + std::to_string(floor.number);
    files::write_grid(options.out, name, title_of(floor, names.name_of(floor)), grid);
    std::printf("%s: %d x %d cells of %g m, floor %d at %.2f m\n", (options.out / (name + ".yaml")).c_str(),
                grid.width, grid.height, grid.resolution_m, floor.number, floor.height_m);
  }
  if (found.read.unreadable > 0) {
    throw DataError(options.directory.string() + ": " + std::to_string(found.read.unreadable) +
                    " tiles are unreadable and left out; the first: " + found.read.first_unreadable);
  }
}

}  // namespace

void add_map_grid_command(CLI::App& map) {
  const auto [command, options] = add_subcommand<GridOptions>(
      map, "grid", "Occupancy grids as pgm and yaml, one a floor, for map_server and Nav2", run_grid);
  command.add_option("DIR", options.directory, "folder of a map, or of a run")->required();
  command.add_option("--out", options.out, "folder for floor_N.pgm and floor_N.yaml, created if missing")
      ->required();
  command.add_option("--floor", options.floor, "number or name of a floor, or all")->capture_default_str();
  command.add_option("--resolution", options.grid.resolution_m, "edge of a cell [m]")
      ->capture_default_str()
      ->check(number_within(0.02, 1.0));
  command
      .add_option("--robot-height", options.grid.robot_height_m,
                  "surfaces higher than this above the ground are no obstacles [m]")
      ->capture_default_str()
      ->check(number_within(0.2, 10.0));
  command
      .add_option("--lowest-obstacle", options.grid.lowest_obstacle_m,
                  "surfaces lower than this above the ground are no obstacles [m]")
      ->capture_default_str()
      ->check(number_within(0.03, 1.0));
}

}  // namespace isobar::tools
