// SPDX-License-Identifier: BSD-3-Clause
// `isobar map floors`: the floors of a map, and their names.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/floors/floor_names.hpp"
#include "run/floors/stored_floors.hpp"
#include "tools/map_parts.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

using Json = nlohmann::ordered_json;

struct FloorsOptions {
  std::filesystem::path directory;
  std::vector<std::string> names;
  bool json = false;
};

/// Millimetres: JSON would print 17 digits of a float.
double rounded(double value) { return std::round(value * 1000.0) / 1000.0; }

Json floor_json(const Floor& floor, const std::string& name) {
  Json json{{"number", floor.number},
            {"name", name.empty() ? Json(nullptr) : Json(name)},
            {"height_m", rounded(floor.height_m)},
            {"lowest_m", rounded(floor.lowest_m)},
            {"highest_m", rounded(floor.highest_m)},
            {"extent_m", nullptr},
            {"area_m2", rounded(floor.area_m2)},
            {"driven_m", rounded(floor.driven_m)},
            {"certainty", rounded(floor.certainty)},
            {"terrain", floor.is_terrain}};
  if (!floor.extent_m.isEmpty()) {
    const Eigen::Vector2d& low = floor.extent_m.min();
    const Eigen::Vector2d& high = floor.extent_m.max();
    json["extent_m"] = {rounded(low.x()), rounded(low.y()), rounded(high.x()), rounded(high.y())};
  }
  return json;
}

void print_json(const Floors& floors, const files::FloorNames& names) {
  Json json{{"floors", Json::array()}, {"half_levels", Json::array()}};
  for (const Floor& floor : floors.floors) json["floors"].push_back(floor_json(floor, names.name_of(floor)));
  for (const HalfLevel& level : floors.half_levels) {
    json["half_levels"].push_back({{"height_m", rounded(level.height_m)},
                                   {"driven_m", rounded(level.driven_m)},
                                   {"area_m2", rounded(level.area_m2)}});
  }
  std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

std::string extent_text(const Floor& floor) {
  if (floor.extent_m.isEmpty()) return "-";
  const Eigen::Vector2d& low = floor.extent_m.min();
  const Eigen::Vector2d& high = floor.extent_m.max();
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.1f … %.1f, %.1f … %.1f", low.x(), high.x(), low.y(), high.y());
  return text.data();
}

void print_table(const Floors& floors, const files::FloorNames& names) {
  std::printf("%6s  %-20s %9s  %8s  %8s  %9s  %s\n", "floor", "name", "height m", "area m2", "driven m",
              "certainty", "extent x, y m");
  for (const Floor& floor : floors.floors) {
    const std::string name = names.name_of(floor);
    std::printf("%6d  %-20s %9.2f  %8.0f  %8.0f  %9.2f  %s%s\n", floor.number,
                name.empty() ? "-" : name.c_str(), floor.height_m, floor.area_m2, floor.driven_m,
                floor.certainty, extent_text(floor).c_str(), floor.is_terrain ? "  (terrain)" : "");
  }
  for (const HalfLevel& level : floors.half_levels) {
    std::printf("no floor: a level at %.2f m, driven %.0f m, %.0f m2 (landing, split level or mezzanine)\n",
                level.height_m, level.driven_m, level.area_m2);
  }
}

/// "NUMBER=NAME" or "OLD NAME=NAME".
void set_name(const std::string& word, const std::filesystem::path& map, const Floors& floors,
              files::FloorNames& names) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) throw UsageError("--name: must be FLOOR=NAME, is '" + word + "'");
  const Floor& floor = files::floor_by(floors, names, word.substr(0, equals));
  names.set(map, floor, word.substr(equals + 1));
}

void run_floors(const FloorsOptions& options) {
  const std::filesystem::path map = map_folder_of(options.directory);
  const auto store = open_map(options.directory);
  files::FloorNames names = files::FloorNames::read(map);
  const std::filesystem::path trajectory = files::trajectory_of_map(map);
  const std::vector<Eigen::Vector3d> path = files::path_of(trajectory);
  const files::StoredFloors found = files::find_stored_floors(*store, path);
  for (const std::string& word : options.names) set_name(word, map, found.floors, names);
  if (options.json) {
    print_json(found.floors, names);
  } else {
    print_faults(store->counters());
    if (path.empty()) std::printf("no trajectory beside the map: floors are where the most ground is\n");
    print_table(found.floors, names);
  }
  if (found.read.unreadable > 0) {
    throw DataError(options.directory.string() + ": " + std::to_string(found.read.unreadable) +
                    " tiles are unreadable and left out; the first: " + found.read.first_unreadable);
  }
}

}  // namespace

double base_height_on(const std::filesystem::path& directory, const std::string& floor) {
  const std::filesystem::path map = map_folder_of(directory);
  const auto store = open_map(directory);
  const files::StoredFloors found =
      files::find_stored_floors(*store, files::path_of(files::trajectory_of_map(map)));
  return files::floor_by(found.floors, files::FloorNames::read(map), floor).height_m +
         found.floors.base_height_m;
}

void add_map_floors_command(CLI::App& map) {
  const auto [command, options] = add_subcommand<FloorsOptions>(
      map, "floors", "Floors of the map: number, name, height, extent", run_floors);
  command.add_option("DIR", options.directory, "folder of a map, or of a run")->required();
  command
      .add_option("--name", options.names,
                  "FLOOR=NAME: name a floor by its number or former name; kept in floors.toml")
      ->take_all();
  command.add_flag("--json", options.json, "print JSON");
}

}  // namespace isobar::tools
